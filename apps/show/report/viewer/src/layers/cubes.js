// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Layers of voxels: the map, what a pose adds, where new surface is expected.
import { Color } from "three";
import { hitColours, ramps } from "../colours.js";
import { quantile } from "../data/parts.js";
import { unitFor } from "../format.js";
import { cubes } from "../scene/cubes.js";

const greatest = (values) => {
  const high = values.reduce((most, value) => (value > most ? value : most), 0);
  return high > 0 ? high : 1;
};

const mapColour = "#8b97a8";

export const map = {
  id: "map",
  label: "Map, occupied",
  on: true,
  swatch: mapColour,
  ofAllSteps: () => true,
  has: (step) => step.map && step.map.centers.rows > 0,
  async build({ step, report, stage }) {
    const { centers, size } = await report.part(step.map);
    const linear = new Color(mapColour).toArray();
    const write = (i, target) => [target[0], target[1], target[2]] = linear;
    return { object: stage.cutaway.apply(cubes(centers, size, write)) };
  },
};

export const contributions = {
  id: "contributions",
  label: "What the pose adds",
  on: true,
  swatch: hitColours.unknown,
  has: (step) => step.contributions && step.contributions.centers.rows > 0,
  async build({ step, report, stage }) {
    const { centers, value, state, unit, size } = await report.part(step.contributions);
    const high = greatest(value);
    const { name, factor } = unitFor(unit, high);
    const write = (i, target) =>
      (state[i] === 1 ? ramps.unknown : ramps.occupied).write(value[i] / high, target, 0);
    const bar = (title, ramp) => ({ title, ramp, low: 0, high: high * factor });
    const legend = [
      bar(`per unknown voxel [${name}]`, ramps.unknown),
      bar(`per occupied voxel [${name}]`, ramps.occupied),
    ];
    return { object: stage.cutaway.apply(cubes(centers, size, write, { scale: 1.06 })), legend };
  },
};

export const expected = {
  id: "expected",
  label: "Expected surface",
  on: false,
  swatch: ramps.unknown.css(0.7),
  has: (step) => step.expected && step.expected.centers.rows > 0,
  async build({ step, report, stage }) {
    const { centers, value, unit, size } = await report.part(step.expected);
    const high = quantile(value, 0.98) || 1;
    const { name, factor } = unitFor(unit, high);
    const write = (i, target) => ramps.unknown.write(value[i] / high, target, 0);
    const legend = { title: `expected per voxel [${name}]`, ramp: ramps.unknown, low: 0, high: high * factor, open: true };
    return { object: stage.cutaway.apply(cubes(centers, size, write)), legend };
  },
};
