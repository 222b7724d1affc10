// SPDX-License-Identifier: Apache-2.0
// The key that a server may ask for. It is kept for this tab alone, sent as a header and never shown.

const PLACE = 'tinsmith-key';

/** What a header can carry. */
export const isPossibleKey = (key: string) => /^[\x21-\x7e]+$/.test(key);

class Access {
  key = '';
  /** Asks the reader for a key; false: there is none. `wasRefused`: one was sent, and not taken. */
  ask: (wasRefused: boolean) => Promise<boolean> = () => Promise.resolve(false);
  /** Hears of a key that came or went. */
  changed: () => void = () => {};
  private asking: Promise<boolean> | null = null;

  constructor() {
    try {
      this.key = sessionStorage.getItem(PLACE) ?? '';
    } catch {
      // Without storage it lasts until the page is left.
    }
  }

  keep(key: string) {
    this.key = key;
    try {
      if (key) sessionStorage.setItem(PLACE, key); else sessionStorage.removeItem(PLACE);
    } catch {
      // As above.
    }
    this.changed();
  }

  headers(): Record<string, string> {
    return this.key ? {Authorization: `Bearer ${this.key}`} : {};
  }

  /** After a 401 to a request that carried `sent`: whether it is worth sending again. Requests that run
      side by side ask once. */
  async again(sent: string): Promise<boolean> {
    if (this.asking) return this.asking;
    if (this.key !== sent) return this.key !== '';
    this.asking = this.ask(sent !== '').finally(() => { this.asking = null; });
    return this.asking;
  }
}

export const access = new Access();
