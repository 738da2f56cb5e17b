// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Counts checks and tells which failed.
let done = 0;
let failed = 0;

export function check(holds, what) {
  ++done;
  if (holds) return;
  ++failed;
  console.log(`FAILED: ${what}`);
}

export function summary() {
  console.log(`${done} checks, ${failed} failed`);
  return failed === 0 && done > 0;
}
