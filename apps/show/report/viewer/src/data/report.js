// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The report's data as steps: the views of a run, or the ranks of scored poses.
import { PartCache, quantile } from "./parts.js";

/** What another report's page or a run.json holds. */
export function dataOf(text) {
  const page = /<script type="application\/json" id="data">([^]*?)<\/script>/.exec(text);
  return JSON.parse(page ? page[1] : text);
}

/** The run of such data: its name and its figures by views. */
export function otherRun(name, data) {
  const figures = data.per_view ?? data.views?.map((view) => view.figures);
  if (!Array.isArray(figures) || figures.length === 0) throw new Error("it holds no run");
  const { policy, gain, mesh } = data.settings ?? {};
  return { name: `${data.title ?? mesh?.split("/").pop() ?? name}, ${policy === "gain" ? `gain ${gain}` : `policy ${policy}`}`, figures };
}

/** What is shown at once: of a run a view, of scored poses the map and one pose. */
function stepsOf(data) {
  if (data.kind === "reconstruct") return data.views;
  const { map, candidates, rows, shown } = data.score;
  const shownOf = new Map(shown.map((entry) => [entry.candidate, entry]));
  const steps = rows.map((row) => ({
    map,
    candidates,
    chosen: row[0],
    bundle: shownOf.get(row[0])?.bundle ?? null,
    contributions: shownOf.get(row[0])?.contributions ?? null,
    row,
  }));
  const nothing = { map, candidates, chosen: null, bundle: null, contributions: null, row: null };
  return steps.length > 0 ? steps : [nothing];
}

export class Report {
  #cache = new PartCache();
  #ranges = new Map();

  constructor(data) {
    if (data.format !== 1) throw new Error(`the data have format ${data.format}, this page reads 1`);
    if (data.kind !== "reconstruct" && data.kind !== "score") {
      throw new Error(`the data are of kind ${data.kind}`);
    }
    Object.assign(this, data);
    this.steps = stepsOf(data);
    if (this.steps.length === 0) throw new Error("the run has no view");
  }

  get isRun() {
    return this.kind === "reconstruct";
  }

  /** What ranks the poses, for people. */
  get byWhat() {
    const { policy } = this.settings ?? {};
    const gain = `gain ${this.gain_model} [${this.gain_unit}]`;
    return !policy || policy === "gain" ? gain : `policy ${policy}; ${gain}`;
  }

  part(raw) {
    return this.#cache.get(raw);
  }

  /**
   * A range of colours that holds for all views, so that they can be compared: that of 95 % of the values
   * of the first and of the last view.
   */
  range(name, valuesOf) {
    if (!this.#ranges.has(name)) {
      const ends = [this.steps[0], this.steps[this.steps.length - 1]];
      const found = Promise.all(ends.map(async (step) => {
        const values = await valuesOf(step);
        return [quantile(values, 0.025), quantile(values, 0.975)];
      }));
      const range = found.then((both) => {
        const known = both.flat().filter(Number.isFinite);
        const [low, high] = [Math.min(...known), Math.max(...known)];
        return high > low ? { low, high } : { low: 0, high: high > 0 ? high : 1 };
      });
      this.#ranges.set(name, range);
    }
    return this.#ranges.get(name);
  }
}
