// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The slider over the steps, and what happened in the one shown.
import { byId, el } from "../dom.js";
import { count, none, percent, stopWords, withUnit, words } from "../format.js";

const playEvery = 1100;

const sum = (counts) => Object.values(counts ?? {}).reduce((total, n) => total + n, 0);

function runStory(report, index) {
  const step = report.steps[index];
  const f = step.figures;
  const parts = [];
  if (f.frame) parts.push(`Recorded as ${f.frame}`);
  else if (index === 0) parts.push("The first view");
  else parts.push(f.class ? `Chosen for a ${f.class} boundary` : `Chosen from ${words(f.generator ?? none)}`);
  let shows = `${index > 0 ? ", it" : ""} shows ${withUnit(f.realised_area, "m^2")} of new surface`;
  if (Number.isFinite(f.predicted_area)) shows += `, ${withUnit(f.predicted_area, "m^2")} predicted`;
  parts.push(Number.isFinite(f.realised_area) ? `${shows}.` : ".");
  if (Number.isFinite(f.coverage_visible)) {
    parts.push(` Coverage ${percent(f.coverage_visible)}, RMS error ${withUnit(f.rms_error, "m")}.`);
  }
  const reasons = step.candidates?.reason ?? [];
  const kept = reasons.filter((r) => r === -1).length;
  if (step.chosen !== null && step.chosen !== undefined) {
    parts.push(` Next: the chosen one of ${count(kept, "candidate", "candidates")}`);
    parts.push(reasons.length > kept ? `, ${count(reasons.length - kept, "was", "were")} dropped.` : ".");
  } else if (index === report.steps.length - 1 && report.summary?.stop_reason) {
    parts.push(` The run ended: ${stopWords(report.summary.stop_reason)}.`);
  }
  return parts.join("");
}

function scoreStory(report, index) {
  const { row, bundle } = report.steps[index];
  if (!row) return "No pose was scored.";
  const gain = report.score.columns.indexOf("gain");
  const value = gain < 0 ? "" : `: gain ${withUnit(row[gain], report.gain_unit)}`;
  const rays = bundle ? "" : " Its rays are not in this report, only those of the best poses.";
  const lost = sum(report.summary?.dropped);
  const dropped = lost ? ` ${count(lost, "pose was", "poses were")} dropped.` : "";
  return `Pose ${row[0]} ranks ${index + 1} of ${report.steps.length.toLocaleString("en")}${value}.${rays}${dropped}`;
}

export function buildTimeline(state, report) {
  const last = report.steps.length - 1;
  const noun = report.isRun ? "View" : "Rank";
  // Views are numbered from 0 as in run.json, ranks from 1.
  const nameOf = (step) => (report.isRun ? `${noun} ${step}` : `${noun} ${step + 1}`);
  const go = (step) => state.set({ step: Math.min(last, Math.max(0, step)) });
  const button = (text, label, onclick) =>
    el("button", { type: "button", "aria-label": label, title: label, onclick }, text);

  let timer = null;
  const stop = () => {
    clearInterval(timer);
    timer = null;
    play.textContent = "▶";
    play.setAttribute("aria-label", "Play");
  };
  const togglePlay = () => {
    if (timer !== null) return stop();
    if (state.values.step === last) go(0);
    play.textContent = "❚❚";
    play.setAttribute("aria-label", "Pause");
    timer = setInterval(() => {
      if (state.values.step === last) stop();
      else go(state.values.step + 1);
    }, playEvery);
  };
  const back = button("◀", `${noun} before (←)`, () => go(state.values.step - 1));
  const play = button("▶", "Play", togglePlay);
  play.title = "Play or pause (space)";
  play.id = "play";
  const forth = button("▶", `${noun} after (→)`, () => go(state.values.step + 1));
  back.className = forth.className = "step";
  const slider = el("input", { type: "range", id: "slider", min: "0", max: String(last), step: "1",
    "aria-label": noun, oninput: () => go(Number(slider.value)) });
  const where = el("output", { id: "where", for: "slider" });
  document.querySelector("#timeline .controls").append(back, play, forth, slider, where);

  state.follow(["step"], ({ step }) => {
    slider.value = String(step);
    slider.style.setProperty("--done", `${last > 0 ? (100 * step) / last : 100}%`);
    const of = report.isRun ? last : last + 1;
    slider.setAttribute("aria-valuetext", `${nameOf(step)} of ${of}`);
    where.replaceChildren(el("b", {}, nameOf(step)), ` / ${of.toLocaleString("en")}`);
    back.disabled = step === 0;
    forth.disabled = step === last;
    byId("story").textContent = report.isRun ? runStory(report, step) : scoreStory(report, step);
  });
  return { go, togglePlay, last };
}
