// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Layers of poses, which runs and scored poses share: candidates, the chosen one, the selected one.
import { Group } from "three";
import { chosenColour, hitColours, ramps, selectedColour } from "../colours.js";
import { poseAt } from "../data/parts.js";
import { unitFor } from "../format.js";
import { frustumLines, pyramids } from "../scene/frusta.js";
import { bundleOf } from "../scene/lines.js";

/** The kept ones, the greatest gain first and unknown gains last. */
export function keptByGain({ gain, reason }) {
  const kept = reason.flatMap((r, i) => (r === -1 ? [i] : []));
  const order = (i) => (Number.isNaN(gain[i]) ? -Infinity : gain[i]);
  return kept.sort((a, b) => order(b) - order(a) || a - b);
}

export function gainRange({ gain, reason }) {
  let [low, high] = [Infinity, -Infinity];
  gain.forEach((g, i) => {
    if (Number.isNaN(g) || reason[i] !== -1) return;
    low = Math.min(low, g);
    high = Math.max(high, g);
  });
  if (low > high) return { low: 0, high: 1 };
  return { low, high: high > low ? high : low + 1 };
}

export const candidates = {
  id: "candidates",
  label: "Candidates by gain",
  on: true,
  swatch: ramps.gain.css(0.6),
  ofAllSteps: (report) => !report.isRun,
  has: (step) => step.candidates && step.candidates.reason.includes(-1),
  key: ({ best }) => best,
  async build({ step, report, stage, values }) {
    const part = await report.part(step.candidates);
    const { low, high } = gainRange(part);
    const unit = unitFor(report.gain_unit, high);
    const indices = keptByGain(part).slice(0, values.best);
    const write = (index, target, at) =>
      ramps.gain.write((part.gain[index] - low) / (high - low), target, at);
    // Many would hide what they look at.
    const size = Math.min(0.075, Math.max(0.034, 0.9 / Math.sqrt(indices.length))) * stage.radius;
    const object = pyramids(part.poses, indices, report.frustum, size, write);
    const legend = {
      title: `gain [${unit.name}]`,
      ramp: ramps.gain,
      low: low * unit.factor,
      high: high * unit.factor,
    };
    return { object, legend, pickable: true };
  },
};

export const dropped = {
  id: "dropped",
  label: "Dropped candidates",
  on: false,
  swatch: "#8a929d",
  ofAllSteps: (report) => !report.isRun,
  has: (step) => step.candidates && step.candidates.reason.some((r) => r !== -1),
  async build({ step, report, stage }) {
    const part = await report.part(step.candidates);
    const indices = part.reason.flatMap((r, i) => (r === -1 ? [] : [i]));
    const size = indices.length > 300 ? 0.028 : 0.05;
    const write = (index, target, at) => target.fill(0.22, at, at + 3);
    const object = pyramids(part.poses, indices, report.frustum, size * stage.radius, write, 0.55);
    return { object, pickable: true };
  },
};

export const chosen = {
  id: "chosen",
  label: "Next view and its rays",
  on: true,
  swatch: chosenColour,
  has: (step) => step.candidates && step.chosen !== null,
  async build({ step, report, stage }) {
    const { poses } = await report.part(step.candidates);
    const pose = poseAt(poses, step.chosen);
    const object = new Group();
    object.add(frustumLines(pose, report.frustum, 0.2 * stage.radius, chosenColour, 3));
    if (!step.bundle) return { object };
    object.add(bundleOf(await report.part(step.bundle), pose));
    const marks = [["unknown", hitColours.unknown], ["occupied", hitColours.occupied]];
    return { object, legend: { title: "rays meet", marks } };
  },
};

/** Shown whenever there is one. */
export const selected = {
  id: "selected",
  has: (step, { candidate }) => step.candidates && candidate !== null,
  key: ({ candidate }) => candidate,
  async build({ step, report, stage, values }) {
    const { poses } = await report.part(step.candidates);
    const pose = poseAt(poses, values.candidate);
    const sight = stage.centre.distanceTo({ x: pose[3], y: pose[7], z: pose[11] });
    const object = frustumLines(pose, report.frustum, 0.2 * stage.radius, selectedColour, 3.5, sight);
    // It was asked for, so nothing hides it.
    object.material.depthTest = false;
    return { object };
  },
};
