// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Why a candidate was chosen, kept or dropped, with the figures that decided.
import { angleBetween, distance, distanceToPoints, outOfReach, positionOf } from "../data/limits.js";
import { poseAt } from "../data/parts.js";
import { fixed, short, withUnit, words } from "../format.js";
import { keptByGain } from "../layers/candidates.js";

/** Lengths in mm, from a metre on in m. */
const length = (metres) => (metres >= 1 ? withUnit(metres, "m as it is") : `${short(Math.round(1e3 * metres))} mm`);

function share(part, of) {
  const percent = 100 * Math.abs(part / of);
  return percent < 0.05 ? "less than 0.1 %" : `${fixed(percent, percent < 9.95 ? 1 : 0)} %`;
}

/** Of the view `step` and its candidates; `surface`: corners of the surface so far. */
export function reasonsOf(report, step, part, surface) {
  const { settings = {}, limits, gain_unit: unit } = report;
  const perMetre = settings.cost_per_metre ?? 0;
  const byGain = !settings.policy || settings.policy === "gain";
  const taken = report.steps.slice(0, report.steps.indexOf(step) + 1).map(({ pose }) => pose);
  const now = positionOf(step.pose);
  const poseOf = (id) => poseAt(part.poses, id);
  const cost = (id) => perMetre * distance(now, positionOf(poseOf(id)));
  const worth = (id) => part.gain[id] - cost(id);
  const order = keptByGain(part);
  const exact = new Set(part.exact);
  const most = byGain && perMetre > 0 ? worth : (id) => part.gain[id];
  const { chosen } = step;

  function ofChosen() {
    if (!byGain) return `policy ${settings.policy}; its gain ranks ${order.indexOf(chosen) + 1} of ${order.length}`;
    const others = order.filter((id) => id !== chosen && exact.has(id)).map(most);
    const next = Math.max(...others);
    const name = perMetre > 0 ? "gain less path cost" : "gain";
    const own = most(chosen);
    const values = perMetre > 0 ? ` ${withUnit(part.gain[chosen], unit)} − ${withUnit(cost(chosen), unit)} =` : "";
    if (settings.plan > 1) return `first of a plan of ${settings.plan} views; gain ${withUnit(own, unit)}`;
    if (!Number.isFinite(next) || own <= 0) return `largest ${name}:${values} ${withUnit(own, unit)}`;
    return own >= next ? `largest ${name}:${values} ${withUnit(own, unit)}, ${share(own - next, own)} above the next`
      : `${name}${values} ${withUnit(own, unit)}, ${share(next - own, next)} below the largest`;
  }

  function ofKept(id) {
    const [own, best] = [most(id), most(chosen)];
    if (chosen === null || !Number.isFinite(own) || !(best > 0)) return "possible";
    if (!byGain) return `possible; not the choice of policy ${settings.policy}`;
    const about = exact.has(id) ? "" : "≈ ";
    const what = perMetre > 0 ? "gain less path cost" : "gain";
    return `${what} ${about}${share(best - own, best)} ${own > best ? "above" : "below"} the chosen`;
  }

  const nearest = (id) => {
    const metres = distanceToPoints(positionOf(poseOf(id)), surface);
    return Number.isFinite(metres) ? `; surface at ${length(metres)}` : "";
  };
  const ofDropped = {
    unreachable: (id) => {
      const metres = outOfReach(positionOf(poseOf(id)), limits);
      return metres > 0 ? `${metres < 5e-4 ? "under 1 mm" : length(metres)} outside the reach` : "outside the reach";
    },
    taken: (id) => {
      const own = poseOf(id);
      const metres = taken.map((pose) => distance(positionOf(pose), positionOf(own)));
      const degrees = taken.map((pose) => angleBetween(pose, own));
      // A degree counts as a centimetre.
      const apart = metres.map((far, i) => far + 0.01 * degrees[i]);
      const view = apart.indexOf(Math.min(...apart));
      return `like view ${view}, ${length(metres[view])} and ${fixed(degrees[view], 1)}° apart`;
    },
    plane: (id) => {
      const height = Number.isFinite(settings.support_plane)
        ? `; camera ${length(poseOf(id)[11] - settings.support_plane)} above` : "";
      return `body touches the table${height}`;
    },
    obstacle: () => "body touches an obstacle",
    collision: (id) => `body touches unknown or occupied space${nearest(id)}`,
    too_near: (id) => {
      const range = Number.isFinite(limits?.min_range)
        ? `over ${fixed(100 * limits.near_share, 0)} % of rays end within the least range, ${length(limits.min_range)}`
        : "too many rays end within the camera's least range";
      return `${range}${nearest(id)}`;
    },
    bad_pose: () => "its pose is not finite or not rigid",
    missed: () => "it was commanded and not reached",
  };
  return (id, reason) => {
    if (reason !== null) return Object.hasOwn(ofDropped, reason) ? ofDropped[reason](id) : words(reason);
    return id === chosen ? ofChosen() : ofKept(id);
  };
}
