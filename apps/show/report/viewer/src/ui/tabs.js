// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The tabs of the side panel.
import { byId, el } from "../dom.js";

/** tabs: id, name, content. */
export function buildTabs(state, tabs) {
  const panel = byId("panel");
  const strip = panel.querySelector("[role=tablist]");
  const buttons = tabs.map(({ id, name, content }) => {
    const button = el("button", { type: "button", role: "tab", id: `tab-${id}`, "aria-controls": `panel-${id}`,
      onclick: () => state.set({ tab: id }) }, name);
    const body = el("div", { role: "tabpanel", id: `panel-${id}`, "aria-labelledby": `tab-${id}` }, content);
    strip.append(button);
    panel.append(body);
    state.follow(["tab"], ({ tab }) => {
      const open = tab === id;
      button.setAttribute("aria-selected", open);
      button.tabIndex = open ? 0 : -1;
      body.hidden = !open;
    });
    return button;
  });
  strip.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    // The arrows would step through the views.
    event.stopPropagation();
    const at = tabs.findIndex(({ id }) => id === state.values.tab);
    const to = (at + by + tabs.length) % tabs.length;
    state.set({ tab: tabs[to].id });
    buttons[to].focus();
  });
}
