// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The 3-D stage: renderer, camera, light and how the user moves the camera. Draws only when asked.
import {
  Color, DirectionalLight, Group, HemisphereLight, PerspectiveCamera, Raycaster, Scene, Spherical,
  Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Cutaway } from "./cutaway.js";
import { fittingPosition } from "./framing.js";

const homeFieldOfView = 36;
// What home shows stays this far from the edges of the free part of the picture [px].
const homeMargin = 22;

const column = (pose, c) => new Vector3(pose[c], pose[4 + c], pose[8 + c]);

export class Stage {
  #asked = false;
  #size = new Vector2();

  /** Throws where the browser has no WebGL. */
  constructor(host, { centre, radius, azimuth, height }) {
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    host.append(this.canvas);

    this.centre = centre;
    this.radius = radius;
    this.renderer.localClippingEnabled = true;
    this.cutaway = new Cutaway();
    this.homeDirection = new Vector3().setFromSphericalCoords(1, Math.PI / 2 - height, azimuth);
    // Spherical coordinates have their pole along y.
    this.homeDirection.set(this.homeDirection.z, this.homeDirection.x, this.homeDirection.y);
    // Strips of the picture that other parts of the page cover [px].
    this.covered = { left: 0, top: 0, bottom: 0 };
    this.scene = new Scene();
    this.content = new Group();
    this.camera = new PerspectiveCamera(homeFieldOfView, 1, radius / 100, radius * 40);
    this.camera.up.set(0, 0, 1);
    const headlight = new DirectionalLight(0xffffff, 1.7);
    headlight.position.set(-0.35, 0.55, 1);
    this.camera.add(headlight, headlight.target);
    headlight.target.position.set(0, 0, -1);
    this.sky = new HemisphereLight(0xffffff, 0xffffff, 1.5);
    this.sky.position.set(0, 0, 1);
    this.scene.add(this.camera, this.sky, this.content);

    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = radius / 20;
    this.controls.maxDistance = radius * 15;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.isHome = false));
    new ResizeObserver(() => this.#fit(host)).observe(host);
    this.#fit(host);
    this.home([centre]);
  }

  #fit(host) {
    const { clientWidth: width, clientHeight: height } = host;
    if (width === 0 || height === 0) return;
    this.#size.set(width, height);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.#shift();
    this.drawNow();
  }

  /** Leaves strips of pixels out: the left one always, those above and below when it goes home. */
  setCovered(strips) {
    Object.assign(this.covered, strips);
    this.#shift();
    this.draw();
  }

  #shift() {
    const { width, height } = this.#size;
    this.camera.setViewOffset(width, height, -this.covered.left / 2, 0, width, height);
  }

  setColours(background, ground) {
    this.scene.background = new Color(background);
    this.sky.groundColor.set(ground);
    this.draw();
  }

  draw() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.drawNow();
    });
  }

  drawNow() {
    this.controls.update();
    this.cutaway.update(this.camera.position, this.controls.target, this.radius);
    this.renderer.render(this.scene, this.camera);
    this.onDraw?.();
  }

  /** On the screen, at the point that is looked at. */
  pixelsPerMetre() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return this.#size.y / (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360));
  }

  #setFieldOfView(degrees) {
    this.camera.fov = degrees;
    this.camera.updateProjectionMatrix();
  }

  /** The tangents of the half angles of what is left free, with a margin. */
  #freeTangents() {
    const { width, height } = this.#size;
    const focal = height / 2 / Math.tan((this.camera.fov * Math.PI) / 360);
    const { left, top, bottom } = this.covered;
    const tangent = (pixels) => Math.max(0.1 * height, pixels - homeMargin) / Math.max(1, focal);
    return { aside: tangent((width - left) / 2), top: tangent(height / 2 - top), bottom: tangent(height / 2 - bottom) };
  }

  /** Looks from the report's side so that all points are in the free part of the picture. */
  home(points) {
    this.#setFieldOfView(homeFieldOfView);
    const position = fittingPosition(points, this.homeDirection, this.#freeTangents());
    const depth = Math.max(this.radius / 4, position.clone().sub(this.centre).dot(this.homeDirection));
    this.camera.position.copy(position);
    this.controls.target.copy(position).addScaledVector(this.homeDirection, -depth);
    this.isHome = true;
    this.draw();
  }

  /** Whether a point is in the free part of the picture. */
  isInSight(point) {
    this.camera.lookAt(this.controls.target);
    this.camera.updateMatrixWorld();
    const { width, height } = this.#size;
    const at = point.clone().project(this.camera);
    const [x, y] = [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
    const { left, top, bottom } = this.covered;
    return at.z < 1 && x > left && x < width && y > top && y < height - bottom;
  }

  /** Goes back until a camera of the data is in sight. */
  include(pose) {
    const offset = () => this.camera.position.distanceTo(this.controls.target);
    while (!this.isInSight(column(pose, 3)) && offset() < 0.9 * this.controls.maxDistance) this.move(0, 0, 1.05);
  }

  /** Looks through a camera of the data, upright. */
  lookFrom(pose, frustum) {
    this.isHome = false;
    const height = Math.max(...frustum.map(([, y]) => Math.abs(y)));
    const width = Math.max(...frustum.map(([x]) => Math.abs(x)));
    this.#setFieldOfView((360 / Math.PI) * Math.atan(Math.max(height, width / this.camera.aspect)));
    const position = column(pose, 3);
    const forward = column(pose, 2);
    const depth = Math.max(this.radius / 4, this.centre.clone().sub(position).dot(forward));
    this.camera.position.copy(position);
    this.controls.target.copy(position).addScaledVector(forward, depth);
    this.draw();
  }

  /** Turns about the target, by angles [rad], and moves to `scale` times the distance. */
  move(aside, down, scale) {
    this.isHome = false;
    const offset = this.camera.position.clone().sub(this.controls.target);
    // Spherical has its pole along y: turned so that it is the world's z.
    const around = new Spherical().setFromVector3(new Vector3(offset.y, offset.z, offset.x));
    around.theta += aside;
    around.phi = Math.min(Math.PI - 0.02, Math.max(0.02, around.phi + down));
    const { minDistance, maxDistance } = this.controls;
    around.radius = Math.min(maxDistance, Math.max(minDistance, around.radius * scale));
    const moved = new Vector3().setFromSpherical(around);
    this.camera.position.set(moved.z, moved.x, moved.y).add(this.controls.target);
    this.draw();
  }

  /** Calls back with what a click meets of the objects that can be picked, and its instance. */
  onPick(pickable, picked) {
    let start = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      start = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
    });
    this.canvas.addEventListener("pointerup", (event) => {
      if (!start || Math.hypot(event.clientX - start[0], event.clientY - start[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      const x = (2 * (event.clientX - box.left)) / box.width - 1;
      const y = 1 - (2 * (event.clientY - box.top)) / box.height;
      const ray = new Raycaster();
      ray.setFromCamera(new Vector2(x, y), this.camera);
      const [first] = ray.intersectObjects(pickable(), true);
      if (first?.instanceId !== undefined) picked(first.object, first.instanceId);
    });
  }
}

/** Frees what an object holds on the graphics card. */
export function dispose(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.material?.map?.dispose();
    part.material?.dispose();
    if (part.isInstancedMesh) part.dispose();
  });
}
