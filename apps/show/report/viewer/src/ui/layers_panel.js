// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The panel of layers: what is shown and how it is coloured.
import { byId, el, swatch } from "../dom.js";
import { colourings } from "../layers/surfaces.js";

// What is worth seeing together.
const presets = {
  Plan: {
    title: "Boundaries, candidates and the next view",
    layers: ["surface", "boundaries", "candidates", "taken", "chosen"],
    colouring: "plain",
  },
  Sigma: { title: "The surface coloured by its sigma", layers: ["surface", "taken"], colouring: "sigma" },
  Points: { title: "The points as uncertainty ellipsoids", layers: ["points", "taken"], colouring: "plain" },
  New: {
    title: "Where the next view is expected to find surface",
    layers: ["surface", "chosen", "expected"],
    colouring: "plain",
  },
  Error: { title: "The surface coloured by its distance from the truth", layers: ["surface"], colouring: "error" },
};

function choice(label, options, value, choose) {
  const items = options.map(([name, text]) => el("option", { value: name }, text));
  const select = el("select", { onchange: () => choose(select.value) }, ...items);
  select.value = value;
  return { select, row: el("label", { class: "choice" }, el("span", {}, label), select) };
}

export function toggleLayer(state, id) {
  const layers = new Set(state.values.layers);
  if (!layers.delete(id)) layers.add(id);
  state.set({ layers });
}

function presetButtons(state, layers, possible) {
  const known = new Set(layers.map((layer) => layer.id));
  const shown = Object.entries(presets).filter(([, preset]) =>
    preset.layers.every((id) => known.has(id) || id === "boundaries" || id === "candidates") &&
    (preset.colouring === "plain" || possible.includes(preset.colouring)));
  const buttons = shown.map(([name, preset]) => {
    const ids = [...preset.layers, "workspace"].filter((id) => known.has(id));
    const use = () => state.set({ layers: new Set(ids), colouring: preset.colouring });
    const button = el("button", { type: "button", title: preset.title, onclick: use }, name);
    const active = ({ layers: on, colouring }) =>
      on.size === ids.length && ids.every((id) => on.has(id)) && colouring === preset.colouring;
    state.follow(["layers", "colouring"], (v) => button.setAttribute("aria-pressed", active(v)));
    return button;
  });
  return el("div", { class: "presets", role: "group", "aria-label": "Shown together" }, ...buttons);
}

/** The keys 1 to 9 and 0. */
export const keyOfLayer = (index) => (index < 10 ? String((index + 1) % 10) : "");

function layerRow(state, report, layer, index) {
  const toggle = () => toggleLayer(state, layer.id);
  const box = el("input", { type: "checkbox", "data-layer": layer.id, onchange: toggle });
  const key = keyOfLayer(index);
  const row = el("label", { class: "layer" }, box, swatch(layer.swatch), el("span", {}, layer.label),
    key ? el("kbd", {}, key) : null);
  state.follow(["layers"], ({ layers }) => (box.checked = layers.has(layer.id)));
  state.follow(["step"], (values) => {
    const has = layer.has(report.steps[values.step], values, report);
    row.classList.toggle("empty", !has);
    row.title = has ? "" : "nothing in this step";
  });
  return row;
}

const sigmaChoices = [1, 2, 3, 5, 10, 20];

function choices(state, report, layers) {
  const rows = [];
  const possible = colourings(report);
  if (possible.length > 0) {
    const options = ["plain", ...possible].map((name) => [name, name === "sigma" ? "sigma σ" : name]);
    const { select, row } = choice("Colour", options, state.values.colouring,
      (colouring) => state.set({ colouring }));
    select.id = "colouring";
    state.follow(["colouring"], ({ colouring }) => (select.value = colouring));
    rows.push(row);
  }
  if (layers.some((layer) => layer.id === "points")) {
    const options = sigmaChoices.map((n) => [n, `${n} σ`]);
    const { select, row } = choice("Ellipsoids", options, state.values.sigmas,
      (n) => state.set({ sigmas: Number(n) }));
    select.id = "sigmas";
    rows.push(row);
  }
  if (layers.some((layer) => layer.id === "candidates")) {
    const options = [[Infinity, "all"], [200, "best 200"], [50, "best 50"], [10, "best 10"]];
    const { row } = choice("Candidates", options, state.values.best, (n) => state.set({ best: Number(n) }));
    rows.push(row);
  }
  return rows;
}

/** What stands before the scene: walls by themselves, the rest by a slider. */
function cuts(state, stage, walls) {
  const front = el("input", { type: "range", id: "front", min: "0", max: "100", step: "1", value: "0",
    "aria-label": "Cut the front", oninput: () => state.set({ front: Number(front.value) / 100 }) });
  const title = "Fades what is nearest to you";
  const rows = [el("label", { class: "choice", title }, el("span", {}, "Cut front"), front)];
  if (walls.length > 0) {
    const box = el("input", { type: "checkbox", id: "walls", onchange: () => state.set({ walls: box.checked }) });
    box.checked = state.values.walls;
    const why = "Fades walls that stand between you and the scene";
    rows.unshift(el("label", { class: "layer", title: why }, box, el("span", {}, "See through near walls")));
  }
  state.follow(["walls", "front"], (values) => {
    Object.assign(stage.cutaway, { walls: values.walls, front: values.front });
    stage.draw();
  });
  return rows;
}

export function buildLayersPanel(state, report, layers, stage, walls) {
  const panel = byId("layers");
  if (report.isRun) panel.append(presetButtons(state, layers, colourings(report)));
  panel.append(...layers.map((layer, index) => layerRow(state, report, layer, index)));
  panel.append(...choices(state, report, layers), ...cuts(state, stage, walls));
  panel.open = matchMedia("(min-width: 901px)").matches;
}
