// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Where the stage is looked at from.
import { byId, el } from "../dom.js";
import { poseAt } from "../data/parts.js";
import { axesLength, cameraPoints, nearCorner, workspacePoints } from "../scene/framing.js";

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
  /** The camera that matters in this step: selected, chosen, or the one just taken. */
  const cameraOf = async (values) => (await planned(report, values)) ?? report.steps[values.step].pose ?? null;
  const pyramid = (pose) => cameraPoints(pose, report.frustum, 0.2 * stage.radius);
  const home = async () => {
    const pose = await cameraOf(state.values);
    const workspace = workspacePoints(report.workspace, report.T_world_grid);
    const corner = nearCorner(workspace, stage.homeDirection);
    // The axes' names are a little beyond their ends.
    const beyond = 1.3 * axesLength * stage.radius;
    const axes = [0, 1, 2].map((axis) => corner.clone().setComponent(axis, corner.getComponent(axis) + beyond));
    stage.home([...workspace, ...axes, ...(pose ? pyramid(pose) : [])]);
  };
  const button = (name, title, onclick) => el("button", { type: "button", title, onclick }, name);
  const next = button(report.isRun ? "From next" : "From pose", "Look through the next or the selected pose (N)", look);
  const tools = [button("Home", "Look at the workspace and the chosen camera (H)", home)];
  if (report.isRun) tools.push(button("From view", "Look through the view just taken (V)", lookTaken));
  tools.push(next);
  byId("camera-tools").append(...tools);
  state.follow(["step", "candidate"], async ({ candidate }) => {
    // Whoever went elsewhere stays there; but a pose that was asked for must be in sight.
    const isAsked = !report.isRun || candidate !== null;
    if (!isAsked && !stage.isHome) return;
    const pose = isAsked ? await planned(report, state.values) : await cameraOf(state.values);
    if (!pose) return;
    if (stage.isHome && !pyramid(pose).every((point) => stage.isInSight(point))) await home();
    else if (isAsked) stage.include(pose);
  });
  state.follow(["step", "candidate"], ({ step, candidate }) => {
    next.disabled = (candidate ?? report.steps[step].chosen) === null;
  });
  return { home, look, lookTaken: report.isRun ? lookTaken : null };
}
