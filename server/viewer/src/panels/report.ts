// SPDX-License-Identifier: Apache-2.0
// What was promised by the dry run and what was measured, side by side.
import type {Report} from '../api';
import type {App} from '../app';
import type {Draft} from '../draft';
import {brief, bytesText, figures, h, number, shortUnit} from '../ui';

const most = (report: Report, name: 'max_vertical_deviation' | 'max_plan_deviation' | 'max_elevation_change') =>
  Math.max(0, ...report.polygons.map((polygon) => polygon[name]));

function angle(report: Report, when: 'before' | 'after' | 'p1_before' | 'p1_after'): string | null {
  const all = report.polygons.flatMap((polygon) => (polygon.smallest_angle_deg ? [polygon.smallest_angle_deg[when]] : []));
  return all.length ? `${brief(Math.min(...all))}°` : null;
}

const milliseconds = (report: Report) => Object.values(report.time_ms).reduce((sum, value) => sum + value, 0);

export function buildReport(app: App, draft: Draft): HTMLElement {
  const box = h('div', {id: 'report'});
  app.on(['report'], () => {
    const {promised, measured} = draft;
    box.replaceChildren();
    if (!promised && !measured) return;
    const u = shortUnit(app.session?.unit ?? 'metre');
    const row = (title: string, of: (report: Report) => string | null): [string, string | null, string | null] =>
      [title, promised && of(promised), measured && of(measured.report)];
    box.append(figures(measured ? `Integrated: version ${measured.report.version}` : 'Dry run: nothing is changed yet', ['promised', 'measured'], [
      row('Shapes', (r) => number(r.polygons.length)),
      row('Edges crossed', (r) => number(r.totals.crossings)),
      row('New vertices', (r) => number(r.totals.vertices_added)),
      row('New triangles', (r) => number(r.totals.triangles_added)),
      row('Edges swapped', (r) => number(r.totals.edges_swapped)),
      row('Ground moved at most', (r) => `${brief(most(r, 'max_vertical_deviation'))} ${u}`),
      row('Line off in plan', (r) => `${brief(most(r, 'max_plan_deviation'))} ${u}`),
      row('Elevation change', (r) => `${brief(most(r, 'max_elevation_change'))} ${u}`),
      row('Smallest angle before', (r) => angle(r, 'before')),
      row('Smallest angle after', (r) => angle(r, 'after')),
      row('1 % of angles below', (r) => angle(r, 'p1_after')),
      row('Parts outside', (r) => number(r.polygons.reduce((all, p) => all + p.outside.length, 0))),
      row('Server, ms', (r) => number(milliseconds(r), 2)),
    ]));
    if (measured) {
      box.append(h('p', {class: 'cost'}, h('b', {}, `${number(measured.cost.ms)} ms`), ' from click to pixels, ', h('b', {}, bytesText(measured.cost.bytes)),
        ' received of a mesh of ', h('b', {}, bytesText(24 * (app.session?.vertices ?? 0) + 12 * (app.session?.triangles ?? 0)))));
    }
  });
  return box;
}
