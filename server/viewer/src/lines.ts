// SPDX-License-Identifier: Apache-2.0
import {LineMaterial} from 'three/examples/jsm/lines/LineMaterial.js';
import {LineSegments2} from 'three/examples/jsm/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/examples/jsm/lines/LineSegmentsGeometry.js';

export interface LineStyle { colour: string; width: number; above?: boolean; dashed?: boolean }

/** Segments of some pixels' width; `ends` has six numbers for each. */
export class Lines extends LineSegments2 {
  constructor(style: LineStyle) {
    super(new LineSegmentsGeometry(), new LineMaterial({
      color: style.colour, linewidth: style.width, depthTest: !style.above, transparent: style.above ?? false,
      dashed: style.dashed ?? false,
    }));
    this.frustumCulled = false;
    this.visible = false;
    this.renderOrder = style.above ? 5 : 2;
  }

  set(ends: number[]) {
    this.visible = ends.length > 0;
    if (!this.visible) return;
    this.geometry.dispose();
    this.geometry = new LineSegmentsGeometry();
    this.geometry.setPositions(ends);
  }

  dispose() {
    this.removeFromParent();
    this.geometry.dispose();
    this.material.dispose();
  }
}

/** Six numbers for each segment between neighbours that both are there. */
export function segmentsOf(points: (number[] | null)[], origin: number[]): number[] {
  const ends: number[] = [];
  for (let i = 1; i < points.length; ++i) {
    const [a, b] = [points[i - 1], points[i]];
    if (a && b) ends.push(a[0] - origin[0], a[1] - origin[1], a[2] - origin[2], b[0] - origin[0], b[1] - origin[1], b[2] - origin[2]);
  }
  return ends;
}
