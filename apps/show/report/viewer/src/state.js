// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// What the user has chosen; the parts of the page follow it.

export class State {
  #followers = [];

  constructor(values) {
    this.values = values;
  }

  /** Changes values; followers hear of those that differ. */
  set(changes) {
    const changed = Object.keys(changes).filter((key) => this.values[key] !== changes[key]);
    if (changed.length === 0) return;
    this.values = { ...this.values, ...changes };
    for (const { keys, follow } of this.#followers) {
      if (keys.some((key) => changed.includes(key))) follow(this.values);
    }
  }

  /** Calls `follow` now and whenever one of `keys` changes. */
  follow(keys, follow) {
    this.#followers.push({ keys, follow });
    follow(this.values);
  }
}
