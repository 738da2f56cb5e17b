// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Fades what stands between the viewer and the scene: walls seen from outside, and all that is nearer than a cut.
import { Mesh, Plane, Vector3 } from "three";

// Six walls and the cut.
const mostPlanes = 7;
const ghostOpacity = 0.13;
const farAway = 1e6;

export class Cutaway {
  // What lies behind one of these is left out; and the same planes with the other side out. Those in
  // excess are far away: a change of their number would compile the shaders again.
  #planes = Array.from({ length: mostPlanes }, () => new Plane());
  #opposite = Array.from({ length: mostPlanes }, () => new Plane());
  #walls = [];
  /** Whether walls fade; the share of the scene's depth that is cut from the front. */
  walls = true;
  front = 0;

  /** Walls: normal (outwards) and offset of planes; see walls.js. */
  setWalls(walls) {
    this.#walls = walls;
  }

  /** To be called before each picture. */
  update(eye, target, radius) {
    const cuts = this.#walls.filter(({ normal, offset }) => this.walls && normal.dot(eye) > offset);
    if (this.front > 0) {
      const normal = new Vector3().subVectors(eye, target).normalize();
      cuts.push({ normal, offset: normal.dot(target) + radius * (1 - 2 * this.front) });
    }
    const none = { normal: new Vector3(0, 0, 1), offset: farAway };
    for (let i = 0; i < mostPlanes; ++i) {
      const { normal, offset } = cuts[i] ?? none;
      this.#planes[i].normal.copy(normal).negate();
      this.#planes[i].constant = offset;
      this.#opposite[i].copy(this.#planes[i]).negate();
    }
  }

  /** Leaves out what is cut. */
  clip(object) {
    object.material.clippingPlanes = this.#planes;
    return object;
  }

  /** The mesh, of which the cut part is drawn faintly. */
  apply(mesh) {
    const faint = mesh.material.clone();
    Object.assign(faint, { transparent: true, depthWrite: false, opacity: ghostOpacity * faint.opacity,
      clippingPlanes: this.#opposite, clipIntersection: true });
    this.clip(mesh);
    // Copies of instances would be heavy: what is cut of them is gone.
    if (!mesh.isInstancedMesh) mesh.add(new Mesh(mesh.geometry, faint));
    return mesh;
  }
}
