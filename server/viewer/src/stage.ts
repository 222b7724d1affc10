// SPDX-License-Identifier: Apache-2.0
import {Color, Group, Matrix4, type Object3D, PerspectiveCamera, Scene, Vector2, Vector3, WebGLRenderer} from 'three';
import {MapControls} from 'three/examples/jsm/controls/MapControls.js';

/** Frames slower than this while the view moves are drawn with less. */
const SLOW_MS = 60;
const REST_MS = 180;
/** What is drawn of a view that moves is chosen anew after so long. */
const REFRESH_MS = 400;

/** Whether drawing is not the processor's work, for which smooth edges and a million triangles cost too much. */
function hasGraphicsCard(): boolean {
  const context = document.createElement('canvas').getContext('webgl2', {failIfMajorPerformanceCaveat: true});
  if (!context) return false;
  // Browsers that are told to draw so do not call it a caveat.
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const renderer = String(context.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER));
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);
}

/**
 * The canvas: one scene in the session's axes (z up, relative to its origin), drawn when something
 * has changed and not otherwise.
 */
export class Stage {
  readonly scene = new Scene();
  /** What is stretched by the vertical exaggeration. */
  readonly world = new Group();
  readonly camera = new PerspectiveCamera(45, 1, 1, 1e5);
  readonly renderer: WebGLRenderer;
  readonly controls: MapControls;
  /** Called before each frame, for what is HTML above the canvas. */
  readonly onFrame: (() => void)[] = [];
  /** Called when the view has come to rest, is another, or moves so slowly that less should be drawn. */
  onView: () => void = () => {};
  /** The ground as it was, on the left of the part `swipe`; null: no comparison. */
  compare: {before: Object3D; now: Object3D[]; part: number} | null = null;
  frames = 0;
  private pending = false;
  private moving = false;
  private slow = 0;
  private readonly hasCard = hasGraphicsCard();
  /** Frames of this terrain have been slow, or will be. */
  wasSlow = !this.hasCard;
  private lastFrame = 0;
  private lastTook = 0;
  private refreshed = 0;
  private restTimer = 0;
  private economy = false;
  /** A view that is set is no view that moves. */
  private fitting = false;
  private readonly size = new Vector2();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({canvas, antialias: this.hasCard, powerPreference: 'high-performance'});
    this.scene.background = new Color('#e9edea');
    this.scene.add(this.world);
    this.camera.up.set(0, 0, 1);
    this.controls = new MapControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.maxPolarAngle = 1.5;
    this.controls.addEventListener('change', () => { if (!this.fitting) this.moved(); });
    // The library fills its buffers again, but draws nothing by itself.
    canvas.addEventListener('webglcontextrestored', () => { this.invalidate(); });
    new ResizeObserver(() => { this.resize(); }).observe(canvas.parentElement!);
    this.resize();
  }

  private resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement!;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(this.pixelRatio());
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.onView();
    this.invalidate();
  }

  /** Another terrain: what was slow may be fast. */
  startAnew() {
    this.wasSlow = !this.hasCard;
  }

  /** Whether the view moves and less is drawn. */
  get isEconomical() {
    return this.economy;
  }

  /** From an object's own axes to the view's. */
  toClip(object: Object3D): Matrix4 {
    this.camera.updateMatrixWorld();
    object.updateWorldMatrix(true, false);
    return new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).multiply(object.matrixWorld);
  }

  /** Pixels of the canvas for a CSS pixel. */
  pixelRatio() {
    return Math.min(window.devicePixelRatio, 2) * (this.economy ? 0.5 : 1);
  }

  private moved() {
    if (!this.moving) {
      this.moving = true;
      this.lastFrame = 0;
      this.slow = 0;
      // What was slow the last time is not tried again.
      if (this.wasSlow) this.setEconomy(true);
    }
    clearTimeout(this.restTimer);
    const wait = Math.max(REST_MS, 3 * this.lastTook);
    this.restTimer = window.setTimeout(() => {
      this.moving = false;
      this.setEconomy(false);
      this.onView();
    }, wait);
    this.invalidate();
  }

  private setEconomy(economy: boolean) {
    if (economy === this.economy) return;
    this.economy = economy;
    if (economy) this.refresh();
    this.renderer.setPixelRatio(this.pixelRatio());
    this.invalidate();
  }

  private refresh() {
    this.refreshed = performance.now();
    this.onView();
  }

  /** Draws at the next frame. */
  invalidate() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame((now) => { this.pending = false; this.draw(now); });
  }

  /** Resolves when what is now in the scene has been drawn. */
  drawn(): Promise<void> {
    this.invalidate();
    return new Promise((resolve) => requestAnimationFrame(() => {
      // The commands are sent by now; the fence tells when they have been carried out.
      const gl = this.renderer.getContext() as WebGL2RenderingContext;
      const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl.flush();
      const begin = performance.now();
      const look = () => {
        const done = fence === null || gl.isContextLost() || gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED;
        if (!done) { setTimeout(look, 4); return; }
        gl.deleteSync(fence);
        // Who needs so long for one frame is spared animations, and views that move are drawn with less.
        if (performance.now() - begin > 2 * SLOW_MS) this.wasSlow = true;
        resolve();
      };
      setTimeout(look, 0);
    }));
  }

  private draw(now: number) {
    if (this.moving && this.lastFrame) {
      this.lastTook = Math.min(now - this.lastFrame, 1000);
      this.slow = this.lastTook > SLOW_MS ? this.slow + 1 : 0;
      if (this.slow >= 2) {
        this.wasSlow = true;
        this.setEconomy(true);
      }
    }
    this.lastFrame = now;
    if (this.economy && performance.now() - this.refreshed > REFRESH_MS) this.refresh();
    ++this.frames;
    const far = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(far / 100, 0.01);
    this.camera.far = far * 10 + this.reach * 4;
    this.camera.updateProjectionMatrix();
    for (const call of this.onFrame) call();
    this.renderer.getSize(this.size);
    if (!this.compare) {
      this.renderer.setScissorTest(false);
      this.renderer.render(this.scene, this.camera);
      return;
    }
    const {before, now: current, part} = this.compare;
    const edge = Math.round(this.size.x * part);
    this.renderer.setScissorTest(true);
    for (const isBefore of [true, false]) {
      before.visible = isBefore;
      const shown = current.map((object) => object.visible);
      if (isBefore) for (const object of current) object.visible = false;
      this.renderer.setScissor(isBefore ? 0 : edge, 0, isBefore ? edge : this.size.x - edge, this.size.y);
      this.renderer.render(this.scene, this.camera);
      current.forEach((object, i) => { object.visible = shown[i]; });
    }
    before.visible = false;
    this.renderer.setScissorTest(false);
  }

  private reach = 1000;

  /** Looks at a box of the scene from the south, from above, so that it fills the frame. `steep`: straight down. */
  fit(center: Vector3, [width, height, depth]: [number, number, number], steep = false) {
    this.reach = Math.max(width, height, 1);
    const direction = (steep ? new Vector3(0, -1e-4, 1) : new Vector3(-0.08, -0.62, 0.78)).normalize();
    const corners = [-0.5, 0.5].flatMap((x) => [-0.5, 0.5].flatMap((y) => [-0.5, 0.5].map((z) => new Vector3(x * width, y * height, z * depth).add(center))));
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const target = center.clone();
    let back = this.reach / half;
    this.camera.near = this.reach / 1000;
    this.camera.far = this.reach * 100;
    this.camera.updateProjectionMatrix();
    // Nearer and aside, until the corners reach from margin to margin; what stands above has its own.
    for (let round = 0; round < 12; ++round) {
      this.camera.position.copy(target).addScaledVector(direction, back);
      this.camera.lookAt(target);
      this.camera.updateMatrixWorld();
      const seen = corners.map((corner) => corner.clone().project(this.camera));
      const [left, right] = [Math.min(...seen.map(({x}) => x)), Math.max(...seen.map(({x}) => x))];
      const [low, high] = [Math.min(...seen.map(({y}) => y)), Math.max(...seen.map(({y}) => y))];
      const [lowest, highest] = [-0.93, 0.8];
      const side = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0), up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
      target.addScaledVector(side, ((left + right) / 2) * half * this.camera.aspect * back);
      target.addScaledVector(up, ((low + high) / 2 - (lowest + highest) / 2) * half * back);
      back *= Math.max((right - left) / 1.88, (high - low) / (highest - lowest), 0.3);
    }
    // Around a place of the ground, not one above or below it.
    target.addScaledVector(direction, (center.z - target.z) / direction.z);
    this.camera.position.copy(target).addScaledVector(direction, back);
    this.camera.lookAt(target);
    this.controls.target.copy(target);
    this.controls.maxDistance = back * 5;
    this.controls.minDistance = this.reach * 1e-4;
    this.fitting = true;
    this.controls.update();
    this.fitting = false;
    this.onView();
    this.invalidate();
  }

  /** Turns, shifts or nears the view by keys; shares of the view, and radians. */
  nudge(right: number, up: number, turn: number, near: number) {
    const {target} = this.controls;
    const offset = this.camera.position.clone().sub(target);
    const forward = new Vector3(-offset.x, -offset.y, 0).normalize();
    const side = new Vector3(forward.y, -forward.x, 0);
    const step = offset.length();
    const shift = side.multiplyScalar(right * step).addScaledVector(forward, up * step);
    offset.applyAxisAngle(new Vector3(0, 0, 1), turn).multiplyScalar(1 / near);
    target.add(shift);
    this.camera.position.copy(target).add(offset);
    this.controls.update();
    this.moved();
  }

  /** Of a point of the world, in CSS pixels from the canvas's corner; null: behind the eye. */
  project(local: Vector3): {x: number; y: number} | null {
    const p = local.clone();
    p.z *= this.world.scale.z;
    p.project(this.camera);
    if (p.z > 1 || p.z < -1) return null;
    return {x: ((p.x + 1) / 2) * this.canvas.clientWidth, y: ((1 - p.y) / 2) * this.canvas.clientHeight};
  }

  /** The ray under a CSS pixel, in the world's own axes. */
  ray(x: number, y: number): {origin: Vector3; direction: Vector3} {
    const at = new Vector3((x / this.canvas.clientWidth) * 2 - 1, 1 - (y / this.canvas.clientHeight) * 2, 0.5).unproject(this.camera);
    const origin = this.camera.position.clone();
    const direction = at.sub(origin).normalize();
    const z = this.world.scale.z;
    origin.z /= z;
    direction.z /= z;
    return {origin, direction};
  }

  /** Session units for a CSS pixel where the view looks. */
  unitsPerPixel() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / this.canvas.clientHeight;
  }
}
