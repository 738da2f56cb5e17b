// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// From where a report is looked at first.
import { Box3, Sphere, Vector3 } from "three";
import { poseAt } from "../data/parts.js";
import { matrixOf } from "./frusta.js";

// A little off the side shows depth [rad].
const aside = 0.35;
// How far above the scene one looks down from [rad]: further where the cameras do, as into a bin.
const [leastHeight, mostHeight, shareOfCameras] = [0.38, 0.9, 0.65];

/** Where the run started, or the best pose. */
async function firstPose(report) {
  const { pose, chosen, candidates } = report.steps[0];
  if (report.isRun) return pose;
  return chosen === null ? null : poseAt((await report.part(candidates)).poses, chosen);
}

/** The mean angle of the cameras above the ground, seen from the centre [rad]; 0: there are none. */
async function camerasHeight(report, centre) {
  const poses = report.isRun ? report.steps.map(({ pose }) => pose) : [await firstPose(report)];
  const heights = poses.filter(Boolean).map((pose) => Math.atan2(pose[11] - centre.z,
    Math.hypot(pose[3] - centre.x, pose[7] - centre.y)));
  return heights.length > 0 ? heights.reduce((sum, h) => sum + h, 0) / heights.length : 0;
}

/** Points of the whole object, as far as it is known. */
async function objectPoints(report) {
  if (!report.isRun) return (await report.part(report.score.map)).centers;
  const last = report.steps[report.steps.length - 1].surface;
  return (await report.part(report.truth ?? last)).vertices;
}

/** The direction along the ground in which points spread most. */
function longAxis(points) {
  const number = points.length / 3;
  const mean = [0, 0];
  for (let i = 0; i < points.length; i += 3) {
    mean[0] += points[i] / number;
    mean[1] += points[i + 1] / number;
  }
  let [xx, xy, yy] = [0, 0, 0];
  for (let i = 0; i < points.length; i += 3) {
    const [x, y] = [points[i] - mean[0], points[i + 1] - mean[1]];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  return 0.5 * Math.atan2(2 * xy, xx - yy);
}

/** The object's broad side, of the two the one that the first pose is nearer to. */
export async function outlookOf(report) {
  const [x0, y0, z0, x1, y1, z1] = report.workspace;
  const box = new Box3(new Vector3(x0, y0, z0), new Vector3(x1, y1, z1));
  const { center: centre, radius } = box.applyMatrix4(matrixOf(report.T_world_grid)).getBoundingSphere(new Sphere());
  const pose = await firstPose(report);
  const side = longAxis(await objectPoints(report)) + Math.PI / 2;
  const toPose = pose ? Math.atan2(pose[7] - centre.y, pose[3] - centre.x) : -Math.PI / 2;
  const nearer = Math.cos(toPose - side) >= 0 ? side : side + Math.PI;
  const towards = Math.sin(toPose - nearer) >= 0 ? -aside : aside;
  const height = shareOfCameras * (await camerasHeight(report, centre));
  return { centre, radius, azimuth: nearer + towards, height: Math.min(mostHeight, Math.max(leastHeight, height)) };
}
