// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The page of a report: reads the data in it and builds what shows them.
import { otherRun, Report } from "./data/report.js";
import { byId, el } from "./dom.js";
import { layersOf, LayerStack } from "./layers/stack.js";
import { outlookOf } from "./scene/outlook.js";
import { Stage } from "./scene/stage.js";
import { wallsOf } from "./scene/walls.js";
import { State } from "./state.js";
import { buildCameraTools } from "./ui/camera_tools.js";
import { buildCandidateTable } from "./ui/candidate_table.js";
import { buildFigures, showHeadline } from "./ui/figures.js";
import { bindKeys } from "./ui/keys.js";
import { buildLayersPanel, toggleLayer } from "./ui/layers_panel.js";
import { showLegend, showScale } from "./ui/legend.js";
import { buildRankingTable } from "./ui/ranking_table.js";
import { buildPlots } from "./ui/run_plots.js";
import { buildTabs } from "./ui/tabs.js";
import { followTheme, themeColours } from "./ui/theme.js";
import { buildTimeline } from "./ui/timeline.js";
import { buildViewTable } from "./ui/view_table.js";

// Where less than this is left beside the layers, the scene lies under them [px].
const leastFree = 260;

function trouble(text) {
  const line = byId("trouble");
  line.textContent = text;
  line.hidden = false;
}

/** The most candidates that a step kept. */
const mostKept = ({ steps }) =>
  Math.max(...steps.map(({ candidates }) => candidates?.reason.filter((r) => r === -1).length ?? 0));

/** The first view of a run with a choice among candidates, the best of scored poses, or as the address says. */
function startStep(report) {
  const last = report.steps.length - 1;
  const isChoice = ({ candidates, chosen }) =>
    Number.isInteger(chosen) && candidates.reason.filter((reason) => reason === -1).length > 1;
  const first = report.steps.findIndex(isChoice);
  return Math.min(Number(/^#step=(\d+)$/.exec(location.hash)?.[1] ?? (first < 0 ? last : first)), last);
}

/** Null where the browser has no WebGL. */
function stageOn(outlook) {
  try {
    return new Stage(byId("stage"), outlook);
  } catch {
    return null;
  }
}

function withoutStage(state) {
  for (const id of ["layers", "camera-tools", "legend", "scale"]) byId(id).hidden = true;
  byId("stage").append(el("p", { class: "note" }, "This browser has no WebGL: plots and tables without the 3-D viewer."));
  state.follow(["step"], ({ step }) => (byId("viewer").dataset.shown = String(step)));
}

/** The 3-D viewer follows the state; returns the keys that it adds. */
function buildViewer(state, report, stage, layers, walls) {
  const viewer = byId("viewer");
  const stack = new LayerStack(report, stage, layers, (legends) => {
    showLegend(byId("legend"), legends);
    if (!viewer.dataset.drawn) makeRoom();
    viewer.dataset.shown = String(state.values.step);
    viewer.dataset.drawn = String(1 + Number(viewer.dataset.drawn ?? 0));
  });
  stage.cutaway.setWalls(walls);
  buildLayersPanel(state, report, layers, stage, walls);
  const panel = byId("layers");
  const camera = buildCameraTools(state, report, stage);
  const makeRoom = () => {
    stage.setCovered({
      left: panel.open && stage.canvas.clientWidth > panel.offsetWidth + leastFree ? panel.offsetWidth : 0,
      top: byId("camera-tools").offsetHeight + 10,
      bottom: byId("legend").offsetHeight + 10,
    });
    if (stage.isHome) camera.home();
  };
  panel.addEventListener("toggle", makeRoom);
  new ResizeObserver(makeRoom).observe(byId("stage"));
  stage.onDraw = () => showScale(byId("scale"), stage.pixelsPerMetre());
  let colours = null;
  state.follow(["theme"], ({ theme }) => {
    colours = themeColours(theme);
    stage.setColours(colours.stage, colours.ground);
  });
  const show = (values) => {
    stack.show(values, colours).catch((error) => trouble(`This step cannot be shown: ${error.message}`));
  };
  state.follow(["step", "layers", "colouring", "sigmas", "best", "candidate", "theme"], show);
  state.follow(["step"], ({ step }) =>
    stage.canvas.setAttribute("aria-label", report.isRun ? `The scene after view ${step}` : "The map and the poses"));
  stage.onPick(() => stack.pickable(), (object, instance) => {
    const candidate = object.userData.indices[instance];
    const rank = report.isRun ? -1 : report.steps.findIndex(({ chosen }) => chosen === candidate);
    state.set(rank >= 0 ? { step: rank } : { candidate });
  });
  const angle = Math.PI / 24;
  return [
    { keys: ["a", "d"], shown: "A D", does: "turn left, right",
      act: (key) => stage.move(key === "a" ? -angle : angle, 0, 1) },
    { keys: ["w", "s"], shown: "W S", does: "turn up, down",
      act: (key) => stage.move(0, key === "w" ? -angle : angle, 1) },
    { keys: ["+", "=", "-"], shown: "+ -", does: "come closer, go back",
      act: (key) => stage.move(0, 0, key === "-" ? 1.12 : 1 / 1.12) },
    { keys: ["h"], shown: "H", does: "look at the workspace and the chosen camera", act: camera.home },
    ...(camera.lookTaken
      ? [{ keys: ["v"], shown: "V", does: "look through the view just taken", act: camera.lookTaken }] : []),
    { keys: ["n"], shown: "N", does: "look through the next or the selected pose", act: camera.look },
    { keys: layers.slice(0, 10).map((_, i) => String((i + 1) % 10)), shown: "1 … 0", does: "layers on and off",
      act: (key) => toggleLayer(state, layers[(Number(key) + 9) % 10].id) },
  ];
}

async function build(report) {
  byId("title").textContent = report.title;
  document.title = `${report.title} – viewgain`;
  byId("kind").textContent = report.byWhat;
  byId("version").textContent = `viewgain ${report.version}`;

  const layers = layersOf(report);
  const state = new State({
    step: startStep(report),
    candidate: null,
    layers: new Set(layers.filter((layer) => layer.on).map((layer) => layer.id)),
    colouring: "plain",
    sigmas: 3,
    best: report.isRun && mostKept(report) > 400 ? 200 : Infinity,
    walls: true,
    front: 0,
    tab: report.isRun ? "plots" : "ranking",
    other: report.beside ? otherRun(report.beside.name, report.beside) : null,
    theme: "light",
  });
  const toggleTheme = followTheme(state);
  showHeadline(state, report);
  const timeline = buildTimeline(state, report);
  const plots = buildPlots(state, report, timeline.go);
  const tabs = report.isRun
    ? [["plots", "Plots", plots], ["candidates", "Candidates", buildCandidateTable(state, report)],
      ["views", "Views", buildViewTable(state, report, timeline.go)], ["run", "Run", buildFigures(state, report)]]
    : [["ranking", "Ranking", el("div", { class: "ranking" }, plots, buildRankingTable(state, report, timeline.go))],
      ["run", "Run", buildFigures(state, report)]];
  buildTabs(state, tabs.map(([id, name, content]) => ({ id, name, content })));
  // A candidate belongs to its step.
  state.follow(["step"], () => state.set({ candidate: null }));

  const outlook = await outlookOf(report);
  const stage = stageOn(outlook);
  const viewerKeys = stage ? buildViewer(state, report, stage, layers, await wallsOf(report)) : [];
  if (!stage) withoutStage(state);
  bindKeys([
    { keys: ["ArrowLeft", "ArrowRight"], shown: "← →", does: "step before, after",
      act: (key) => timeline.go(state.values.step + (key === "ArrowLeft" ? -1 : 1)) },
    { keys: ["Home", "End"], shown: "Home End", does: "first, last step",
      act: (key) => timeline.go(key === "Home" ? 0 : timeline.last) },
    { keys: [" "], shown: "space", does: "play, pause", act: timeline.togglePlay },
    ...viewerKeys,
    { keys: ["Escape"], shown: "Esc", does: "select no candidate", act: () => state.set({ candidate: null }) },
    { keys: ["t"], shown: "T", does: "light or dark", act: toggleTheme },
  ]);
}

async function start() {
  await build(new Report(JSON.parse(byId("data").textContent)));
}

start().catch((error) => trouble(`This report cannot be shown: ${error.message}`));
