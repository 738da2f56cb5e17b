// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Light and dark: as the system says, until the button says otherwise.
import { byId } from "../dom.js";

const dark = matchMedia("(prefers-color-scheme: dark)");

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** The colours that the 3-D stage takes from the style sheet. */
export const themeColours = (name) => ({
  name,
  stage: colour("stage"),
  surface: colour("surface"),
  ink: colour("ink"),
  ground: colour("ground"),
});

export function followTheme(state) {
  let chosen = null;
  const button = byId("theme");
  const apply = () => {
    const name = chosen ?? (dark.matches ? "dark" : "light");
    document.documentElement.dataset.theme = name;
    const other = name === "dark" ? "light" : "dark";
    button.textContent = name === "dark" ? "☀" : "☾";
    button.setAttribute("aria-label", `Use ${other} colours`);
    button.title = `Use ${other} colours (T)`;
    state.set({ theme: name });
  };
  const toggle = () => {
    chosen = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    apply();
  };
  dark.addEventListener("change", apply);
  button.addEventListener("click", toggle);
  apply();
  return toggle;
}
