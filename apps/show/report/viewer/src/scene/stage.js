// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The 3-D stage: renderer, camera, light and how the user moves the camera. Draws only when asked.
import {
  Color, DirectionalLight, Group, HemisphereLight, PerspectiveCamera, Raycaster, Scene, Spherical,
  Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const homeFieldOfView = 36;
// How far above the scene home looks down from [rad].
const homeHeight = 0.38;
// Home goes back up to this much further, if that brings the first camera in sight.
const homeBack = 1.3;

const column = (pose, c) => new Vector3(pose[c], pose[4 + c], pose[8 + c]);

export class Stage {
  #asked = false;
  #size = new Vector2();

  /** Throws where the browser has no WebGL. */
  constructor(host, { centre, radius, azimuth, firstPose }) {
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    host.append(this.canvas);

    this.centre = centre;
    this.radius = radius;
    this.firstPose = firstPose;
    this.homeDirection = new Vector3().setFromSphericalCoords(1, Math.PI / 2 - homeHeight, azimuth);
    // Spherical coordinates have their pole along y.
    this.homeDirection.set(this.homeDirection.z, this.homeDirection.x, this.homeDirection.y);
    this.aside = 0;
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
    new ResizeObserver(() => this.#fit(host)).observe(host);
    this.#fit(host);
    this.home();
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

  /** Leaves a strip of pixels at the left out when it looks at the middle. */
  setAside(pixels) {
    this.aside = pixels;
    this.#shift();
    this.draw();
  }

  #shift() {
    const { width, height } = this.#size;
    this.camera.setViewOffset(width, height, -this.aside / 2, 0, width, height);
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

  home() {
    this.#setFieldOfView(homeFieldOfView);
    const half = (homeFieldOfView * Math.PI) / 360;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (0.86 * this.radius) / Math.sin(half) / narrow;
    this.controls.target.copy(this.centre);
    this.camera.position.copy(this.centre).addScaledVector(this.homeDirection, distance);
    const near = this.camera.position.clone();
    if (this.firstPose && !this.include(this.firstPose, homeBack)) this.camera.position.copy(near);
    this.draw();
  }

  /**
   * Goes back until a camera of the data is in sight, beside what lies over the stage, but no further
   * than `most` times as far; whether it is.
   */
  include(pose, most = Infinity) {
    const left = -0.92 + (2 * this.aside) / Math.max(1, this.#size.x);
    const inSight = () => {
      this.camera.lookAt(this.controls.target);
      this.camera.updateMatrixWorld();
      const at = column(pose, 3).project(this.camera);
      return at.z < 1 && at.x > left && at.x < 0.92 && Math.abs(at.y) < 0.82;
    };
    const offset = () => this.camera.position.distanceTo(this.controls.target);
    const furthest = Math.min(0.9 * this.controls.maxDistance, most * offset());
    while (!inSight() && offset() < furthest) this.move(0, 0, 1.05);
    return inSight();
  }

  /** Looks through a camera of the data, upright. */
  lookFrom(pose, frustum) {
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
