// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Small plots over the steps. Each shows the value of the step pointed at or selected; a click selects one.
import { el, svg } from "../dom.js";
import { short } from "../format.js";

function frame(wide) {
  const size = { width: wide ? 438 : 212, height: 144, left: 34, right: 6, top: 7, bottom: 27 };
  const inner = {
    width: size.width - size.left - size.right,
    height: size.height - size.top - size.bottom,
  };
  return { size, inner };
}

/** The least of 1, 2, 5, 10, 20, ... that is not under a number. */
function spacing(least) {
  let step = 1;
  while (step < least) step *= String(step).startsWith("2") ? 2.5 : 2;
  return step;
}

/** Even numbers from 0 to the top of an axis. */
function ticksUpTo(high) {
  const power = 10 ** Math.floor(Math.log10(high));
  const step = [0.2, 0.5, 1, 2].map((n) => n * power).find((s) => high / s <= 5.01) ?? 5 * power;
  const steps = Math.ceil(high / step - 1e-9);
  return Array.from({ length: steps + 1 }, (_, i) => i * step);
}

function tickText(tick, top) {
  const [value, suffix] = top >= 10000 ? [tick / 1000, tick > 0 ? "k" : ""] : [tick, ""];
  return `${Number(value.toPrecision(6)).toLocaleString("en")}${suffix}`;
}

const finite = (values) => values.filter(Number.isFinite);

function axes(group, size, ticks, y, places, first, name) {
  for (const tick of ticks) {
    group.append(
      svg("line", { class: "grid", x1: size.left, x2: size.width - size.right, y1: y(tick), y2: y(tick) }),
      svg("text", { x: size.left - 4, y: y(tick) + 3, "text-anchor": "end" }, tickText(tick, ticks[ticks.length - 1])));
  }
  const every = spacing(places.length / 6);
  places.forEach((x, i) => {
    if (i > 0 && (i + first) % every !== 0) return;
    group.append(svg("text", { x, y: size.height - 15, "text-anchor": "middle" }, String(i + first)));
  });
  const middle = (size.left + size.width - size.right) / 2;
  group.append(svg("text", { x: middle, y: size.height - 4, "text-anchor": "middle" }, name));
}

function line(group, series, places, y) {
  let path = "";
  let pen = "M";
  series.values.forEach((value, i) => {
    if (!Number.isFinite(value)) pen = "M";
    else {
      path += `${pen}${places[i].toFixed(1)} ${y(value).toFixed(1)}`;
      pen = "L";
    }
  });
  const radius = places.length > 60 ? 0.9 : places.length > 25 ? 1.8 : 2.4;
  const dots = series.values.map((value, i) => Number.isFinite(value)
    ? svg("circle", { [series.other ? "data-other" : "data-step"]: i, cx: places[i], cy: y(value), r: radius, fill: series.colour,
      class: places.length > 60 ? "small" : null }) : null);
  const stroke = { d: path, stroke: series.colour, fill: "none", class: "line" };
  if (series.dashed) stroke["stroke-dasharray"] = "3 2.5";
  group.append(svg("path", stroke), ...dots.filter(Boolean));
}

function bars(group, series, places, y, width) {
  const base = places.map(() => 0);
  for (const { values, colour } of series) {
    values.forEach((value, i) => {
      if (!(value > 0)) return;
      const [low, high] = [y(base[i]), y(base[i] + value)];
      base[i] += value;
      const place = { x: places[i] - width / 2, y: high, width, height: low - high };
      group.append(svg("rect", { "data-step": i, ...place, fill: colour }));
    });
  }
}

/**
 * @param plot title, unit, finest (step that means something), series (name, values, colour, dashed, other: of another run), stacked, top (of the
 * axis), firstName (the number of the first step), stepName
 */
export function buildPlot(state, plot, go) {
  const { series, stacked, unit } = plot;
  const { size, inner } = frame(plot.wide);
  const steps = Math.max(...series.map(({ values }) => values.length));
  const totals = Array.from({ length: steps }, (_, i) =>
    finite(series.map(({ values }) => values[i])).reduce((sum, v) => (stacked ? sum + v : Math.max(sum, v)), 0));
  const high = plot.top ?? Math.max(...totals, 0);
  const ticks = ticksUpTo(high > 0 ? high : 1);
  const top = ticks[ticks.length - 1];
  const y = (value) => size.top + inner.height * (1 - value / top);
  const pad = stacked ? inner.width / (2 * steps) : 5;
  const places = totals.map((_, i) =>
    size.left + pad + (steps > 1 ? (i / (steps - 1)) * (inner.width - 2 * pad) : inner.width / 2 - pad));

  const marker = svg("line", { class: "marker", y1: size.top, y2: size.top + inner.height });
  const drawing = svg("svg", { viewBox: `0 0 ${size.width} ${size.height}`, role: "img",
    "aria-label": `${plot.title} of ${steps} steps, up to ${short(Math.max(...totals))} ${unit}` });
  axes(drawing, size, ticks, y, places, plot.firstName, plot.stepName);
  drawing.append(marker);
  if (stacked) bars(drawing, series, places, y, Math.max(1, Math.min(14, (0.72 * inner.width) / steps)));
  else series.forEach((one) => line(drawing, one, places, y));

  const readout = el("span", { class: "readout" });
  const several = series.length > 1;
  const tell = (i) => {
    const shown = stacked ? [short(totals[i], plot.finest)]
      : series.filter((one) => Number.isFinite(one.values[i])).map((one) => {
        const value = el("span", {}, short(one.values[i], plot.finest));
        if (several) value.style.color = one.colour;
        return value;
      });
    const gaps = shown.flatMap((value, k) => (k > 0 ? [" / ", value] : [value]));
    readout.replaceChildren(...gaps);
  };
  const nearest = (event) => {
    const box = drawing.getBoundingClientRect();
    const at = ((event.clientX - box.left) / box.width) * size.width;
    const found = places.reduce((best, x, i) => (Math.abs(x - at) < Math.abs(places[best] - at) ? i : best), 0);
    return found;
  };
  drawing.addEventListener("pointermove", (event) => tell(nearest(event)));
  drawing.addEventListener("pointerleave", () => tell(state.values.step));
  drawing.addEventListener("click", (event) => go(nearest(event)));

  state.follow(["step"], ({ step }) => {
    marker.setAttribute("x1", places[step]);
    marker.setAttribute("x2", places[step]);
    drawing.querySelectorAll(".now").forEach((mark) => mark.classList.remove("now"));
    drawing.querySelectorAll(`[data-step="${step}"]`).forEach((mark) => mark.classList.add("now"));
    tell(step);
  });

  const names = several
    ? el("div", { class: "names" }, ...series.map(({ name, colour, dashed }) => {
      const mark = el("i", { class: dashed ? "key dashed" : stacked ? "key block" : "key" });
      mark.style.color = colour;
      return el("span", {}, mark, name);
    })) : null;
  return el("figure", { class: plot.wide ? "plot wide" : "plot", "data-plot": plot.id },
    el("figcaption", {}, el("span", { class: "name" }, plot.title), unit ? el("small", {}, unit) : null, readout),
    drawing, names);
}
