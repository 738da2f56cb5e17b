// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Layers of a run's surface: surface so far, boundaries, patches, points, truth; the view just taken; the box.
import { Group } from "three";
import { classColours, patchColour, ramps, truthColour } from "../colours.js";
import { ellipsoids, greatestSigmas } from "../scene/ellipsoids.js";
import { axesLength, nearCorner, workspacePoints } from "../scene/framing.js";
import { frustumLines, matrixOf } from "../scene/frusta.js";
import { axesAt, boundaryLines, workspaceLines } from "../scene/lines.js";
import { coloursOf, meshOf } from "../scene/meshes.js";

const titles = { sigma: "surface σ [mm]", error: "error [mm]" };

/** What the surface can be coloured by in this report. */
export const colourings = (report) =>
  ["sigma", "error"].filter((name) => report.isRun && report.steps.some((step) => step.surface?.[name]));

// Values outside the range have the colours of its ends.
const barOf = (title, ramp, { low, high }) => ({ title, ramp, low: 1e3 * low, high: 1e3 * high, open: true });

export const surface = {
  id: "surface",
  label: "Surface so far",
  on: true,
  swatch: "var(--surface)",
  has: (step) => step.surface && step.surface.triangles.rows > 0,
  key: ({ colouring }) => colouring,
  async build({ step, report, stage, values, theme }) {
    const part = await report.part(step.surface);
    const by = values.colouring;
    if (!part[by]) return { object: stage.cutaway.apply(meshOf(part, { colour: theme.surface })) };
    const valuesOf = async (end) => (await report.part(end.surface))[by] ?? [];
    const range = await report.range(by, valuesOf);
    const object = stage.cutaway.apply(meshOf(part, { colours: coloursOf(part[by], ramps[by], range) }));
    return { object, legend: barOf(titles[by], ramps[by], range) };
  },
};

export const boundaries = {
  id: "boundaries",
  label: "Boundary runs",
  on: true,
  swatch: `conic-gradient(${[classColours.top, classColours.right, classColours.bottom, classColours.left]
    .map((colour, i) => `${colour} ${90 * i - 45}deg ${90 * i + 45}deg`).join(",")})`,
  has: (step) => step.boundaries && step.boundaries.start.length > 0,
  async build({ step, report, stage }) {
    const object = stage.cutaway.clip(boundaryLines(await report.part(step.boundaries), 4));
    return { object, legend: { title: "boundaries", marks: Object.entries(classColours) } };
  },
};

export const patches = {
  id: "patches",
  label: "Patches fitted there",
  on: false,
  swatch: patchColour,
  has: (step) => step.patches && step.patches.triangles.rows > 0,
  build: async ({ step, report, stage }) => ({
    object: stage.cutaway.apply(meshOf(await report.part(step.patches), { colour: patchColour })),
  }),
};

export const points = {
  id: "points",
  label: "Uncertainty ellipsoids",
  on: false,
  swatch: ramps.sigma.css(0.7),
  has: (step) => step.points && step.points.positions.rows > 0,
  key: ({ sigmas }) => sigmas,
  async build({ step, report, stage, values }) {
    const valuesOf = async (end) => (end.points ? greatestSigmas(await report.part(end.points)) : []);
    const range = await report.range("points", valuesOf);
    const object = ellipsoids(await report.part(step.points), values.sigmas, ramps.sigma, range);
    return { object: stage.cutaway.apply(object), legend: barOf("greatest σ [mm]", ramps.sigma, range) };
  },
};

export const taken = {
  id: "taken",
  label: "View just taken",
  on: true,
  swatch: "var(--ink)",
  has: (step) => Boolean(step.pose),
  build: async ({ step, report, stage, theme }) => ({
    object: frustumLines(step.pose, report.frustum, 0.2 * stage.radius, theme.ink, 2.5),
  }),
};

export const truth = {
  id: "truth",
  label: "Ground truth",
  on: false,
  swatch: truthColour,
  ofAllSteps: () => true,
  has: (step, values, report) => Boolean(report.truth),
  build: async ({ report, stage }) => ({
    object: stage.cutaway.apply(meshOf(await report.part(report.truth), { colour: truthColour, opacity: 0.38 })),
  }),
};

export const workspace = {
  id: "workspace",
  label: "Workspace and axes",
  on: true,
  swatch: "var(--ground)",
  ofAllSteps: () => true,
  has: () => true,
  async build({ report, stage, theme }) {
    const lines = workspaceLines(report.workspace, theme.ground);
    lines.applyMatrix4(matrixOf(report.T_world_grid));
    const corner = nearCorner(workspacePoints(report.workspace, report.T_world_grid), stage.homeDirection);
    const object = new Group();
    object.add(lines, axesAt(corner.toArray(), axesLength * stage.radius, theme.ink));
    return { object };
  },
};
