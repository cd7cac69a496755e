/** Everything that was sent and received, kept by the browser: whatever happens to the page, at most the octets of a line not
 * yet ended are lost. Lines go to localStorage at once and to IndexedDB in batches. */
export interface Entry {
  t: number; // ms
  out: boolean;
  text: string;
}

export interface SessionInfo {
  id: number; // when it began, ms
  link: string;
  lines: number;
  last: number;
}

const DATABASE = 'plomada-ground';
const KEPT = 20;
const BATCH_MS = 1000;
const TAIL = 'plomada.tail.';

function wrap<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

function openDatabase(): Promise<IDBDatabase> {
  const request = indexedDB.open(DATABASE, 1);
  request.onupgradeneeded = () => {
    request.result.createObjectStore('sessions', { keyPath: 'id' });
    request.result.createObjectStore('batches', { keyPath: ['session', 'number'] });
  };
  return wrap(request);
}

export class SessionLog {
  private database: IDBDatabase | null = null;
  private info: SessionInfo | null = null;
  private pending: Entry[] = [];
  private number = 0;
  private timer: ReturnType<typeof setTimeout> | null = null;

  /** Also puts away what a page that vanished has left in localStorage. */
  async start(): Promise<void> {
    try {
      this.database = await openDatabase();
    } catch {
      return; // a private window may have none: the session lives as long as the page
    }
    for (const key of Object.keys(localStorage).filter((name) => name.startsWith(TAIL))) {
      const id = Number(key.slice(TAIL.length));
      const entries = JSON.parse(localStorage.getItem(key) ?? '[]') as Entry[];
      const info = await this.find(id);
      if (info && entries.length > 0) await this.write({ ...info, lines: info.lines + entries.length, last: entries[entries.length - 1]!.t }, Date.now(), entries);
      localStorage.removeItem(key);
    }
    await this.forgetOld();
  }

  async begin(link: string, id = Date.now()): Promise<void> {
    await this.flush();
    this.info = { id, link, lines: 0, last: id };
    this.number = 0;
    if (this.database) await wrap(this.database.transaction('sessions', 'readwrite').objectStore('sessions').put(this.info));
  }

  get current(): SessionInfo | null {
    return this.info;
  }

  add(entry: Entry): void {
    if (!this.info) return;
    this.pending.push(entry);
    try {
      localStorage.setItem(TAIL + this.info.id, JSON.stringify(this.pending));
    } catch {
      // full: the batch below is what remains
    }
    this.timer ??= setTimeout(() => void this.flush(), BATCH_MS);
  }

  async flush(): Promise<void> {
    if (this.timer) clearTimeout(this.timer);
    this.timer = null;
    const entries = this.pending;
    if (!this.info || entries.length === 0) return;
    this.pending = [];
    this.info = { ...this.info, lines: this.info.lines + entries.length, last: entries[entries.length - 1]!.t };
    await this.write(this.info, this.number++, entries);
    if (this.pending.length === 0) localStorage.removeItem(TAIL + this.info.id);
    else localStorage.setItem(TAIL + this.info.id, JSON.stringify(this.pending));
  }

  private async write(info: SessionInfo, number: number, entries: Entry[]): Promise<void> {
    if (!this.database) return;
    const transaction = this.database.transaction(['sessions', 'batches'], 'readwrite');
    transaction.objectStore('batches').put({ session: info.id, number, entries });
    await wrap(transaction.objectStore('sessions').put(info));
  }

  private async find(id: number): Promise<SessionInfo | undefined> {
    return this.database ? wrap<SessionInfo | undefined>(this.database.transaction('sessions').objectStore('sessions').get(id)) : undefined;
  }

  async list(): Promise<SessionInfo[]> {
    if (!this.database) return [];
    const all = await wrap<SessionInfo[]>(this.database.transaction('sessions').objectStore('sessions').getAll());
    return all.sort((a, b) => b.id - a.id);
  }

  async read(id: number): Promise<Entry[]> {
    if (!this.database) return [];
    const range = IDBKeyRange.bound([id, -Infinity], [id, Infinity]);
    const batches = await wrap<{ entries: Entry[] }[]>(this.database.transaction('batches').objectStore('batches').getAll(range));
    return batches.flatMap((batch) => batch.entries).sort((a, b) => a.t - b.t);
  }

  async remove(id: number): Promise<void> {
    if (!this.database) return;
    const transaction = this.database.transaction(['sessions', 'batches'], 'readwrite');
    transaction.objectStore('batches').delete(IDBKeyRange.bound([id, -Infinity], [id, Infinity]));
    await wrap(transaction.objectStore('sessions').delete(id));
  }

  private async forgetOld(): Promise<void> {
    for (const info of (await this.list()).slice(KEPT)) await this.remove(info.id);
  }
}

/** The text of a session as the replay reads it: milliseconds, direction, line. */
export function writeSession(entries: Entry[]): string {
  return entries.map((entry) => `${Math.round(entry.t)} ${entry.out ? '>' : '<'} ${entry.text}\n`).join('');
}
