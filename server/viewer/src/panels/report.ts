// SPDX-License-Identifier: Apache-2.0
// What was promised by the dry run and what was measured, side by side.
import type {Report} from '../api';
import type {App} from '../app';
import type {Draft} from '../draft';
import {type AngleChange, type Angles, anglesOf, BAR_DEGREES} from '../angles';
import {brief, bytesText, figures, h, number, shortUnit, svg} from '../ui';

const most = (report: Report, name: 'max_vertical_deviation' | 'max_plan_deviation' | 'max_elevation_change') =>
  Math.max(0, ...report.polygons.map((polygon) => polygon[name]));

/** The least of all shapes. */
function angle(report: Report, when: 'before' | 'after' | 'p1_after'): string | null {
  const all = report.polygons.flatMap((polygon) => (polygon.smallest_angle_deg ? [polygon.smallest_angle_deg[when]] : []));
  return all.length ? `${brief(Math.min(...all))}°` : null;
}

const milliseconds = (report: Report) => Object.values(report.time_ms).reduce((sum, value) => sum + value, 0);

const [WIDTH, HEIGHT, BOTTOM] = [320, 112, 18];

const told = (when: string, {count, least}: Angles) => `${when}: ${number(count)}${count ? `, least ${brief(least)}°` : ''}`;

/** Smallest angles of the triangles that change: as they were, and as they are or would be, bar beside bar. */
function histogram({before, after}: AngleChange, isDone: boolean): HTMLElement {
  const most = Math.max(1, ...before.bars, ...after.bars);
  const wide = WIDTH / before.bars.length;
  const out = svg('svg', {viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img',
    'aria-label': `Smallest angles in steps of ${BAR_DEGREES} degrees. Before: ${before.bars.join(', ')}. ${isDone ? 'After' : 'They would be'}: ${after.bars.join(', ')}.`});
  const bar = (name: string, i: number, count: number, shift: number) => {
    const high = count ? Math.max(1.5, (count / most) * (HEIGHT - BOTTOM - 14)) : 0;
    const what = svg('rect', {class: name, x: i * wide + shift, y: HEIGHT - BOTTOM - high, width: wide * 0.4, height: high});
    what.append(svg('title', {}, `${number(count)} from ${i * BAR_DEGREES}° to ${(i + 1) * BAR_DEGREES}°`));
    return what;
  };
  before.bars.forEach((count, i) => {
    out.append(bar('was', i, count, wide * 0.08), bar('is', i, after.bars[i], wide * 0.52));
    if (i % 2 === 0) out.append(svg('text', {x: i * wide + 1, y: HEIGHT - 5}, `${i * BAR_DEGREES}°`));
  });
  out.append(svg('line', {class: 'axis', x1: 0, x2: WIDTH, y1: HEIGHT - BOTTOM, y2: HEIGHT - BOTTOM}), svg('text', {x: WIDTH, y: HEIGHT - 5, 'text-anchor': 'end'}, '60°'));
  return h('figure', {class: 'plot angles'}, h('figcaption', {}, h('b', {}, 'Smallest angles of the triangles touched'),
    h('span', {class: 'soft'}, h('i', {class: 'box was'}), told('before', before)),
    h('span', {class: 'soft'}, h('i', {class: 'box is'}), told(isDone ? 'after' : 'would be', after))), out as unknown as HTMLElement);
}

export function buildReport(app: App, draft: Draft): HTMLElement {
  const box = h('div', {id: 'report'});
  app.on(['report'], () => {
    const {promised, measured} = draft;
    box.replaceChildren();
    if (!promised && !measured) return;
    const u = shortUnit(app.session?.unit ?? 'metre');
    const row = (title: string, of: (report: Report) => string | null): [string, string | null, string | null] =>
      [title, promised && of(promised), measured && of(measured.report)];
    if (measured) {
      box.append(h('p', {class: 'cost'}, h('b', {}, `${number(measured.cost.ms)} ms`), ' from click to pixels, ', h('b', {}, bytesText(measured.cost.bytes)),
        ' received of a mesh of ', h('b', {}, bytesText(24 * (app.session?.vertices ?? 0) + 12 * (app.session?.triangles ?? 0)))));
    }
    box.append(figures(measured ? `Integrated: version ${measured.report.version}` : 'Dry run: nothing is changed yet', ['promised', 'measured'], [
      row('Shapes', (r) => number(r.polygons.length)),
      row('Edges crossed', (r) => number(r.totals.crossings)),
      row('New vertices', (r) => number(r.totals.vertices_added)),
      row('New triangles', (r) => number(r.totals.triangles_added)),
      row('Edges swapped', (r) => number(r.totals.edges_swapped)),
      row('Certified deviation', (r) => `${brief(most(r, 'max_vertical_deviation'))} ${u}`),
      row('Line off in plan', (r) => `${brief(most(r, 'max_plan_deviation'))} ${u}`),
      row('Elevation change', (r) => `${brief(most(r, 'max_elevation_change'))} ${u}`),
      row('Smallest angle before', (r) => angle(r, 'before')),
      row('Smallest angle after', (r) => angle(r, 'after')),
      row('1 % of angles below', (r) => angle(r, 'p1_after')),
      row('Parts outside', (r) => number(r.polygons.reduce((all, p) => all + p.outside.length, 0))),
      row('Server, ms', (r) => number(milliseconds(r), 2)),
    ]));
    const angles = measured ? measured.angles : promised && anglesOf(promised);
    if (angles?.after.count) box.append(histogram(angles, measured !== null));
  });
  return box;
}
