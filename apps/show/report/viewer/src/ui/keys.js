// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The keys, and the window that lists them.
import { byId, el } from "../dom.js";

// Elements that use keys themselves.
const takesKeys = (target, key) => {
  if (target.closest("select, textarea, dialog, [role=tablist]")) return true;
  if (target.matches("input[type=range]")) return key.startsWith("Arrow") || key === "Home" || key === "End";
  return key === " " && target.closest("button, summary, input") !== null;
};

/** actions: keys (as in KeyboardEvent.key), shown, does, act. */
export function bindKeys(actions) {
  const help = byId("help");
  const open = () => help.showModal();
  byId("open-help").addEventListener("click", open);
  const all = [...actions, { keys: ["?"], shown: "?", does: "this list", act: open }];
  byId("keys").append(...all.map(({ shown, does }) => el("div", {},
    el("dt", {}, ...shown.split(" ").map((key) => el("kbd", {}, key))), el("dd", {}, does))));
  const byKey = new Map(all.flatMap(({ keys, act }) => keys.map((key) => [key, act])));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const act = byKey.get(key);
    if (!act || takesKeys(event.target, key)) return;
    event.preventDefault();
    act(key);
  });
}
