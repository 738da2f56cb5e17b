// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Without WebGL: the pictures that the program drew.
import { byId, el } from "../dom.js";

export function showPictures(state, report) {
  const viewer = byId("viewer");
  viewer.classList.add("pictures");
  viewer.setAttribute("aria-label", "Pictures");
  for (const id of ["layers", "camera-tools", "legend"]) byId(id).hidden = true;
  const image = el("img", { id: "picture" });
  const note = el("p", { class: "note" });
  byId("stage").append(image, note);
  state.follow(["step"], ({ step }) => {
    const { picture } = report.steps[step];
    image.hidden = !picture;
    if (picture) {
      image.src = `data:image/png;base64,${picture}`;
      image.alt = report.isRun ? `The surface after view ${step}` : "The map and the best poses";
    }
    const why = "This browser has no WebGL";
    note.textContent = picture ? `${why}: a picture instead of the 3-D viewer.`
      : `${why}, and this report holds no picture of the step.`;
    viewer.dataset.shown = String(step);
  });
}
