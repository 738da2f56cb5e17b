// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Keeps on the stage what the layers switched on show of the current step.
import { dispose } from "../scene/stage.js";
import * as ofSurface from "./surfaces.js";
import * as ofPoses from "./candidates.js";
import * as ofCubes from "./cubes.js";

const ofRun = [
  ofSurface.surface, ofSurface.boundaries, ofSurface.patches, ofPoses.candidates, ofPoses.dropped,
  ofSurface.taken, ofPoses.chosen, ofSurface.points, ofCubes.expected, ofSurface.truth, ofSurface.workspace,
];
const ofScore = [
  ofCubes.map, ofPoses.candidates, ofPoses.dropped,
  { ...ofPoses.chosen, label: "Pose and its rays" }, ofCubes.contributions, ofSurface.workspace,
];

/** The layers of this report that have something to show in some step. */
export function layersOf(report) {
  const layers = report.isRun ? ofRun : ofScore;
  return layers.filter((layer) => report.steps.some((step) => layer.has(step, {}, report)));
}

export class LayerStack {
  #shown = new Map();
  #turn = 0;

  constructor(report, stage, layers, onShown) {
    Object.assign(this, { report, stage, layers, onShown });
  }

  #wanted(step, values) {
    const on = this.layers.filter(({ id }) => values.layers.has(id));
    return [...on, ofPoses.selected].filter((layer) => layer.has(step, values, this.report));
  }

  /** Builds what is missing, then changes all at once: no step is ever shown by halves. */
  async show(values, theme) {
    const turn = ++this.#turn;
    const step = this.report.steps[values.step];
    const context = { step, report: this.report, stage: this.stage, values, theme };
    const next = new Map();
    const built = this.#wanted(step, values).map(async (layer) => {
      const place = layer.ofAllSteps?.(this.report) ? "" : values.step;
      const key = [place, theme.name, layer.key?.(values)].join();
      const old = this.#shown.get(layer.id);
      const entry = old?.key === key ? old : { ...(await layer.build(context)), key };
      next.set(layer.id, entry);
    });
    await Promise.all(built);
    const outdated = turn !== this.#turn;
    const [from, to] = outdated ? [next, this.#shown] : [this.#shown, next];
    for (const [id, { object }] of from) {
      if (to.get(id)?.object === object) continue;
      this.stage.content.remove(object);
      dispose(object);
    }
    if (outdated) return;
    this.#shown = next;
    const order = [...this.layers, ofPoses.selected].map(({ id }) => id);
    for (const [id, { object }] of next) {
      // Where two lie at the same depth, the later layer shows, however they came here.
      object.traverse((part) => (part.renderOrder = order.indexOf(id)));
      this.stage.content.add(object);
    }
    this.stage.drawNow();
    this.onShown(this.legends());
  }

  /** In the order of the layers. */
  legends() {
    const entries = this.layers.map(({ id }) => this.#shown.get(id)).filter(Boolean);
    return entries.flatMap(({ legend }) => legend ?? []);
  }

  pickable() {
    return [...this.#shown.values()].filter((entry) => entry.pickable).map((entry) => entry.object);
  }
}
