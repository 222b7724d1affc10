// SPDX-License-Identifier: Apache-2.0
// A terrain from the reader's disk becomes a session, as a job with progress.
import {type Call, type Job, json, Problem, send, type Session, sessionPath, upload} from './api';
import {type App, Said} from './app';

const TYPES: Record<string, string> = {
  tif: 'image/tiff', tiff: 'image/tiff', json: 'application/json', glb: 'model/gltf-binary', gltf: 'model/gltf+json',
  xml: 'application/xml', obj: 'model/obj', csv: 'text/csv', xyz: 'text/csv', asc: 'text/plain', txt: 'text/plain',
};
export const TERRAIN_ENDINGS = Object.keys(TYPES).map((ending) => `.${ending}`).join(',');

/** So many questions in a row may get lost. */
const PATIENCE = 10;

export class Upload {
  progress: {text: string; part: number} | null = null;
  /** Of `PUT /v1/sessions/{id}`, where the file does not say it; '': not asked for. */
  options = {crs: '', unit: '', project: '', repair: ''};
  private job: string | null = null;
  private sending: AbortController | null = null;

  constructor(private readonly app: App) {}

  private tell(text: string, part: number) {
    this.progress = {text, part};
    this.app.tell('progress');
  }

  async take(file: File) {
    const ending = file.name.slice(file.name.lastIndexOf('.') + 1).toLowerCase();
    const stem = file.name.slice(0, -(ending.length + 1)).toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-+|-+$/g, '').slice(0, 40) || 'terrain';
    if (this.progress) throw new Said(`${file.name} was not taken: another file is on its way. One after the other, please.`);
    const taken = new Set(this.app.sessions.map((session) => session.id));
    for (let left = 20; ; --left) {
      let id = stem;
      for (let n = 2; taken.has(id); ++n) id = `${stem}-${n}`;
      try {
        await this.put(id, file, TYPES[ending] || file.type || 'application/octet-stream');
        await this.app.listSessions();
        return await this.app.open(id);
      } catch (error) {
        // By somebody since the list was read, or by one whose terrains are not shown here.
        if (!(error instanceof Problem && error.word === 'id-taken' && left > 0)) throw error;
        taken.add(id);
      }
    }
  }

  private async put(id: string, file: File, type: string) {
    const call: Call = {
      method: 'PUT', path: `/v1/sessions/${id}`, query: Object.fromEntries(Object.entries(this.options).filter(([, value]) => value !== '')),
      body: file, file: file.name,
      headers: {'Content-Type': type, Prefer: 'respond-async'},
    };
    this.app.note(call);
    try {
      this.tell(`Sending ${file.name}`, 0);
      this.sending = new AbortController();
      const sent = await upload(call, (part) => { this.tell(`Sending ${file.name}`, part / 2); }, this.sending.signal);
      this.sending = null;
      if (sent.status === 202) await this.follow(sent.location!, file.name);
    } finally {
      this.progress = null;
      this.job = this.sending = null;
      this.app.tell('progress');
    }
  }

  /** Until the job ends. */
  private async follow(location: string, name: string) {
    this.job = location;
    for (let pause = 60; ; pause = Math.min(pause * 1.5, 500)) {
      const job = await this.poll(location);
      this.tell(`Building the mesh of ${name}`, 0.5 + job.progress / 2);
      if (job.state === 'done') return;
      if (job.state === 'stopped') throw new Problem(499, '', 'Stopped', `${name} was not loaded.`, [], null);
      // What went wrong is the answer that the request would have had.
      if (job.state === 'failed') { await send({method: 'GET', path: `${location}/result`}); return; }
      await new Promise((resolve) => setTimeout(resolve, pause));
    }
  }

  /** The job goes on whether it is asked for or not: a question that gets lost is asked again. */
  private async poll(location: string): Promise<Job> {
    for (let left = PATIENCE; ; --left) {
      try {
        return await json<Job>({method: 'GET', path: location});
      } catch (error) {
        if (!(error instanceof Problem && error.isPassing && left > 0)) throw error;
        await new Promise((resolve) => setTimeout(resolve, 1000 * (error.retryAfter ?? 1)));
      }
    }
  }

  async stop() {
    this.sending?.abort();
    if (!this.job) return;
    const call: Call = {method: 'DELETE', path: this.job};
    this.app.note(call);
    await send(call);
  }

  async fork() {
    const call: Call = {method: 'POST', path: this.app.path('/fork')};
    this.app.note(call);
    const made = await json<Session>(call);
    await this.app.listSessions();
    await this.app.open(made.id);
  }

  async remove(id: string) {
    const {app} = this;
    const call: Call = {method: 'DELETE', path: sessionPath(id)};
    app.note(call);
    await send(call);
    await app.listSessions();
    if (app.session?.id !== id) return;
    if (app.sessions[0]) await app.open(app.sessions[0].id); else app.close();
  }
}
