// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Where the stage is looked at from.
import { byId, el } from "../dom.js";
import { poseAt } from "../data/parts.js";

/** The poses that the stage can be seen from: the selected candidate before the chosen one. */
async function planned(report, { step, candidate }) {
  const { candidates, chosen } = report.steps[step];
  const index = candidate ?? chosen;
  return candidates && index !== null ? poseAt((await report.part(candidates)).poses, index) : null;
}

export function buildCameraTools(state, report, stage) {
  const look = async () => {
    const pose = await planned(report, state.values);
    if (pose) stage.lookFrom(pose, report.frustum);
  };
  const lookTaken = () => stage.lookFrom(report.steps[state.values.step].pose, report.frustum);
  const home = () => stage.home();
  const button = (name, title, onclick) => el("button", { type: "button", title, onclick }, name);
  const next = button(report.isRun ? "From next" : "From pose", "Look through the next or the selected pose (N)", look);
  const tools = [button("Home", "Look at everything (H)", home)];
  if (report.isRun) tools.push(button("From view", "Look through the view just taken (V)", lookTaken));
  tools.push(next);
  byId("camera-tools").append(...tools);
  state.follow(["step", "candidate"], async ({ candidate }) => {
    // A run is watched from where one stands; a pose that was asked for must be in sight.
    if (report.isRun && candidate === null) return;
    const pose = await planned(report, state.values);
    if (pose) stage.include(pose);
  });
  state.follow(["step", "candidate"], ({ step, candidate }) => {
    next.disabled = (candidate ?? report.steps[step].chosen) === null;
  });
  return { home, look, lookTaken: report.isRun ? lookTaken : null };
}
