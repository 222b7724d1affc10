// SPDX-License-Identifier: Apache-2.0
// What the mouse, the finger and the keys do on the canvas.
import type {App} from './app';
import type {Draft} from './draft';
import type {Hit} from './ground_index';
import type {Stage} from './stage';
import {byId} from './ui';

const CLICK_PIXELS = 6;
const DOUBLE_MS = 400;

export class Pointer {
  hover: Hit | null = null;
  onFinish: () => void = () => {};
  private down: {x: number; y: number} | null = null;
  private lastClick = {x: 0, y: 0, when: -Infinity};
  private waiting: {x: number; y: number} | null = null;

  constructor(private readonly app: App, private readonly draft: Draft, private readonly stage: Stage, private readonly fit: () => void) {
    const {canvas} = stage;
    canvas.addEventListener('pointerdown', (event) => { this.down = {x: event.offsetX, y: event.offsetY}; byId('frame').classList.remove('keys'); });
    canvas.addEventListener('pointerup', (event) => { this.up(event); });
    canvas.addEventListener('pointermove', (event) => { this.move(event); });
    canvas.addEventListener('pointerleave', () => { this.hover = null; app.tell('hover'); });
    canvas.addEventListener('contextmenu', (event) => { event.preventDefault(); });
    canvas.addEventListener('keydown', (event) => { this.key(event); });
    document.addEventListener('keydown', (event) => { this.anywhere(event); });
    app.on(['draft'], () => { canvas.classList.toggle('drawing', draft.drawing); });
  }

  at(x: number, y: number): Hit | null {
    const {origin, direction} = this.stage.ray(x, y);
    const o = this.app.mesh.origin;
    return this.app.ground.hit([origin.x + o[0], origin.y + o[1], origin.z + o[2]], [direction.x, direction.y, direction.z]);
  }

  private move(event: PointerEvent) {
    if (event.buttons !== 0 && !this.draft.drawing) return;
    const first = this.waiting === null;
    this.waiting = {x: event.offsetX, y: event.offsetY};
    if (!first) return;
    requestAnimationFrame(() => {
      const {x, y} = this.waiting!;
      this.waiting = null;
      this.hover = this.at(x, y);
      this.app.tell('hover');
    });
  }

  private up(event: PointerEvent) {
    const {down} = this;
    this.down = null;
    const [x, y] = [event.offsetX, event.offsetY];
    if (!down || event.button !== 0 || Math.hypot(x - down.x, y - down.y) > CLICK_PIXELS) return;
    const last = this.lastClick;
    const isDouble = event.timeStamp - last.when < DOUBLE_MS && Math.hypot(x - last.x, y - last.y) <= CLICK_PIXELS;
    this.lastClick = {x, y, when: isDouble ? -Infinity : event.timeStamp};
    if (this.draft.drawing) {
      if (isDouble) this.finish(); else this.set(this.at(x, y));
      return;
    }
    this.pick(this.at(x, y));
  }

  private set(hit: Hit | null) {
    if (hit) this.draft.add(hit.x, hit.y); else this.app.say('There is no terrain there.');
  }

  private finish() {
    if (this.draft.finish()) this.onFinish();
  }

  /** Selects the smallest region under the cursor. */
  private pick(hit: Hit | null) {
    if (!hit) return;
    const found = this.app.around(hit.triangle)[0];
    this.app.selected = found ? found.polygon : null;
    if (found) {
      this.app.say(`Region ${found.polygon} selected.`);
      this.app.openTab('regions');
    }
    this.app.tell('selection');
  }

  private key(event: KeyboardEvent) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const {stage} = this;
    const step = 0.06, angle = 0.12;
    const moves: Record<string, () => void> = event.shiftKey
      ? {ArrowLeft: () => { stage.nudge(0, 0, -angle, 1); }, ArrowRight: () => { stage.nudge(0, 0, angle, 1); }, '+': () => { stage.nudge(0, 0, 0, 1.2); }}
      : {
        ArrowLeft: () => { stage.nudge(-step, 0, 0, 1); }, ArrowRight: () => { stage.nudge(step, 0, 0, 1); },
        ArrowUp: () => { stage.nudge(0, step, 0, 1); }, ArrowDown: () => { stage.nudge(0, -step, 0, 1); },
        '+': () => { stage.nudge(0, 0, 0, 1.2); }, '=': () => { stage.nudge(0, 0, 0, 1.2); }, '-': () => { stage.nudge(0, 0, 0, 1 / 1.2); },
        Home: this.fit,
        ' ': () => { if (this.draft.drawing) this.set(this.at(stage.canvas.clientWidth / 2, stage.canvas.clientHeight / 2)); },
      };
    const act = moves[event.key];
    if (!act) return;
    event.preventDefault();
    byId('frame').classList.add('keys');
    act();
    requestAnimationFrame(() => {
      this.hover = this.at(stage.canvas.clientWidth / 2, stage.canvas.clientHeight / 2);
      this.app.tell('hover');
    });
  }

  private anywhere(event: KeyboardEvent) {
    const target = event.target as HTMLElement;
    if (target.closest('input, textarea, select')) return;
    if (event.key.toLowerCase() === 'z' && (event.ctrlKey || event.metaKey)) {
      event.preventDefault();
      byId<HTMLButtonElement>(event.shiftKey ? 'redo' : 'undo').click();
      return;
    }
    if (!this.draft.drawing) return;
    if (event.key === 'Enter' && !target.closest('button, summary, a')) { event.preventDefault(); this.finish(); }
    if (event.key === 'Escape') this.draft.cancel();
    if (event.key === 'Backspace') { event.preventDefault(); this.draft.takeBack(); }
  }
}
