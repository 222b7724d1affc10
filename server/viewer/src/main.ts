// SPDX-License-Identifier: Apache-2.0
import {Problem} from './api';
import {App, Said} from './app';
import {Compare} from './compare';
import {CursorView} from './cursor_view';
import {Draft} from './draft';
import {buildLegend, buildLooks, buildReadout} from './furniture';
import {Overlay} from './overlay';
import {buildCalls} from './panels/calls';
import {buildDraw} from './panels/draw';
import {buildHead, buildTabs} from './panels/head';
import {buildHistory, buildUndo} from './panels/history';
import {buildKey} from './panels/key';
import {buildProblem} from './panels/problem';
import {buildProfile} from './panels/profile';
import {buildRegions} from './panels/regions';
import {buildTerrain, isOutOfService} from './panels/terrain';
import {Pointer} from './pointer';
import {Profile} from './profile';
import {RegionEdit} from './region_edit';
import {Stage} from './stage';
import {byId, h} from './ui';
import {Upload} from './upload';
import {View} from './view';

const GEOJSON_TYPE = /"type"\s*:\s*"(Feature|FeatureCollection|GeometryCollection|(Multi)?(Point|LineString|Polygon))"/;
const HEAD_BYTES = 65536;

/** A browser that cannot draw says so where the terrain would be. */
function makeStage(canvas: HTMLCanvasElement): Stage {
  try {
    return new Stage(canvas);
  } catch (error) {
    const welcome = byId('welcome');
    welcome.hidden = false;
    welcome.replaceChildren(h('h2', {}, 'This browser draws no terrain'),
      h('p', {}, 'WebGL 2 is missing or switched off. Everything can be done without this page, too: see the ', h('a', {href: 'docs'}, 'API'), '.'));
    throw error;
  }
}

const app = new App();
const draft = new Draft(app);
const stage = makeStage(byId<HTMLCanvasElement>('view'));
const view = new View(app, draft, stage);
const compare = new Compare(app, view.ramp);
view.compare = compare;
const overlay = new Overlay(app, draft, stage);
const pointer = new Pointer(app, draft, stage, () => { view.fit(); });
const profile = new Profile(app, compare);
const edit = new RegionEdit(app);
const upload = new Upload(app);
const live = byId('live');
app.say = (text) => { live.textContent = text; };

const isGeoJson = (head: string) => GEOJSON_TYPE.test(head) && !/"(mesh|grid|points)"\s*:/.test(head);

function takeShape(name: string, text: string) {
  app.openTab('draw');
  void app.attempt(async () => {
    try { draft.take(name, text); } catch { throw new Said(`${name || 'What was pasted'} is not JSON.`); }
    await draft.dryRun();
  });
}

/** A file is a terrain, or polygons where it is GeoJSON. */
async function take(file: File) {
  const read = (part: Blob) => part.text().catch(() => { throw new Said(`${file.name} cannot be read: is it still there, and not a folder?`); });
  const text = await app.attempt(async () => {
    const isText = /\.(geo)?json$/i.test(file.name);
    return isText && isGeoJson(await read(file.slice(0, HEAD_BYTES))) ? read(file) : '';
  });
  if (text === undefined) return;
  if (text) {
    takeShape(file.name, text);
  } else {
    app.openTab('terrain');
    await app.attempt(() => upload.take(file));
  }
}

buildKey();
buildHead(app);
buildUndo(app);
buildProblem(app, view);
buildCalls(app);
buildLegend(app, view);
buildReadout(app, pointer);
buildLooks(app, view, overlay, compare);
buildTabs(app, [
  ['terrain', 'Terrain', buildTerrain(app, upload, (file) => { void take(file); })],
  ['draw', 'Draw', buildDraw(app, draft, (file) => { void take(file); })],
  ['regions', 'Regions', buildRegions(app, edit, view)],
  ['profile', 'Profile', buildProfile(app, draft, profile, view)],
  ['history', 'History', buildHistory(app, compare)],
]);
new CursorView(app, draft, pointer, stage);
let hint = '';
const showHint = () => {
  byId('hint').textContent = draft.drawing ? 'Click to set corners. Enter finishes, Backspace takes back, Escape cancels.' : hint;
};
view.hint = (text) => { hint = text; showHint(); };
app.on(['draft'], showHint);
app.on(['session'], () => { byId('welcome').hidden = app.session !== null; });
byId('welcome-load').addEventListener('click', () => { byId('file').click(); });
app.on(['progress'], () => { document.body.classList.toggle('busy', app.busy > 0); });
pointer.onFinish = () => {
  void app.attempt(() => (draft.kind === 'Profile' ? profile.ask([...draft.points]) : draft.dryRun()));
};

/** What is dropped or pasted: a file, or text that is GeoJSON. */
function takeFrom(data: DataTransfer | null): boolean {
  const file = data?.files[0], text = data?.getData('text/plain') ?? '';
  if (data && data.files.length > 1) void app.attempt(() => Promise.reject(new Said('These are several files: drop one at a time.')));
  else if (file) void take(file);
  else if (isGeoJson(text.slice(0, HEAD_BYTES))) takeShape('', text);
  else return false;
  return true;
}

for (const kind of ['dragenter', 'dragover']) {
  document.addEventListener(kind, (event) => { event.preventDefault(); document.body.classList.add('dropping'); });
}
document.addEventListener('dragleave', (event) => { if (!event.relatedTarget) document.body.classList.remove('dropping'); });
document.addEventListener('drop', (event) => {
  event.preventDefault();
  document.body.classList.remove('dropping');
  if (!takeFrom(event.dataTransfer)) app.say('That is neither a file nor GeoJSON.');
});
document.addEventListener('paste', (event) => {
  if ((event.target as HTMLElement).closest?.('input, textarea')) return;
  if (takeFrom(event.clipboardData)) event.preventDefault();
});
// Others may have changed the terrain while the page was not looked at.
document.addEventListener('visibilitychange', () => {
  if (document.visibilityState === 'visible' && app.busy === 0) void app.lookAgain();
});

app.on(['tab'], () => { if (app.tab === 'terrain' && app.session) void app.quietly(() => app.listSessions()); });

/** The terrain that the address names. */
function wanted(): string {
  try {
    return decodeURIComponent(location.hash.slice(1));
  } catch {
    return '';
  }
}
addEventListener('hashchange', () => {
  const id = wanted();
  if (id && id !== app.session?.id) void app.attempt(() => app.open(id));
});

/** A server that has just been started reads its sessions first, and says so. */
async function listWhenReady() {
  for (let left = 120; ; --left) {
    try {
      await app.listSessions();
      break;
    } catch (error) {
      if (!(error instanceof Problem && error.word === 'not-ready' && left > 0)) throw error;
      view.hint('The server is starting …');
      await new Promise((resolve) => setTimeout(resolve, 1000 * (error.retryAfter ?? 1)));
    }
  }
  view.hint('');
}

void app.attempt(async () => {
  await listWhenReady();
  const there = app.sessions.filter((session) => !isOutOfService(session)).map(({id}) => id);
  const id = wanted();
  const first = [id, 'demo', there[0]].find((one) => there.includes(one));
  if (first) await app.open(first);
  else { app.close(); app.openTab('terrain'); }
  if (id && id !== first) throw new Said(`There is no terrain "${id}" here${first ? `: this is ${first}.` : '.'}`);
});
// For those who measure: `tinsmith.stage.frames`, and the mesh as it is.
Object.assign(window, {tinsmith: {app, stage, view, draft, edit, pointer, profile}});
