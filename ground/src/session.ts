import { keep, keptAs, keptNames } from './keep';

/** Everything that was sent and received, kept by the browser: whatever happens to the page, at most the octets of a line not
 * yet ended are lost. Lines go to localStorage at once (the tail) and to IndexedDB in batches. A batch that cannot be written stays
 * in this page and is tried again. A tail has the number of the batch that it becomes: whoever writes it, this page or one that finds
 * it, writes the same batch. */
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

interface Batch {
  session: number;
  number: number;
  entries: Entry[];
}

const DATABASE = 'plomada-ground';
const KEPT = 20;
const BATCH_MS = 1000;
const TAIL = 'tail.';

const isEntry = (x: Partial<Entry> | null): x is Entry => typeof x === 'object' && x !== null && Number.isFinite(x.t) && typeof x.out === 'boolean' && typeof x.text === 'string';
const isInfo = (x: Partial<SessionInfo> | null): x is SessionInfo => typeof x === 'object' && x !== null && Number.isFinite(x.id) && typeof x.link === 'string' && Number.isFinite(x.lines) && Number.isFinite(x.last);

function wrap<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

/** Kept only when the transaction is complete: a full disk is told then. */
function complete(transaction: IDBTransaction): Promise<void> {
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve();
    transaction.onabort = transaction.onerror = () => reject(transaction.error ?? new DOMException('aborted', 'AbortError'));
  });
}

async function openDatabase(again = true): Promise<IDBDatabase> {
  const request = indexedDB.open(DATABASE, 1);
  request.onupgradeneeded = () => {
    request.result.createObjectStore('sessions', { keyPath: 'id' });
    request.result.createObjectStore('batches', { keyPath: ['session', 'number'] });
  };
  const database = await wrap(request);
  if (['sessions', 'batches'].every((name) => database.objectStoreNames.contains(name)) || !again) return database;
  database.close(); // one of this name with nothing of ours in it
  await wrap(indexedDB.deleteDatabase(DATABASE));
  return openDatabase(false);
}

/** A session of this page, and what of it is not yet in the database. */
interface Running {
  info: SessionInfo;
  number: number; // of the next batch
  pending: Entry[];
  left: () => void;
}

/** Other tabs see by this lock that a session's page lives. */
const lockOf = (id: number): string => `plomada-session-${id}`;

export class SessionLog {
  /** Records of the store that could not be read, by where they stand. */
  private readonly bad = new Map<string, number>();
  /** Lines that the browser has refused to keep so far: they are in this page only. */
  refused = 0;
  private database: IDBDatabase | null = null;
  private running: Running[] = []; // the last one is the current; others have still something to write
  private timer: ReturnType<typeof setTimeout> | null = null;
  private flushing: Promise<void> = Promise.resolve();

  /** Also puts away what a page that vanished has left in localStorage. */
  async start(): Promise<void> {
    const database = await this.store();
    if (!database) return;
    for (const name of keptNames(TAIL)) {
      if (await this.livesElsewhere(Number(name.slice(TAIL.length)))) continue;
      const tail = keptAs<{ info: SessionInfo; number: number; entries: Entry[] } | null>(name, (text) => JSON.parse(text) as never, null);
      if (tail && isInfo(tail.info) && Number.isFinite(tail.number) && Array.isArray(tail.entries)) {
        await this.write(database, tail.info, tail.number, tail.entries.filter(isEntry));
      } else {
        this.bad.set(name, 1);
      }
      keep(name, null);
    }
    for (const info of (await this.list()).slice(KEPT)) await this.remove(info.id);
  }

  async begin(link: string): Promise<void> {
    this.leave();
    let left = (): void => undefined;
    const lives = new Promise<void>((done) => (left = done));
    const last = this.current?.info.id ?? 0;
    const info = { id: Math.max(Date.now(), last + 1), link, lines: 0, last: Date.now() };
    this.running.push({ info, number: 0, pending: [], left });
    await this.flush();
    const database = await this.store();
    if (database) {
      const transaction = database.transaction('sessions', 'readwrite');
      const sessions = transaction.objectStore('sessions');
      while ((await wrap(sessions.getKey(info.id))) !== undefined) info.id++; // two tabs in one millisecond
      sessions.put(info);
      await complete(transaction).catch(() => undefined); // its first batch tells whether the store refuses
    }
    void navigator.locks?.request(lockOf(info.id), () => lives).catch(() => undefined);
  }

  /** The page goes, or the session is over: other tabs may take care of what is left of it. */
  leave(): void {
    this.current?.left();
  }

  get damaged(): number {
    return [...this.bad.values()].reduce((sum, one) => sum + one, 0);
  }

  get id(): number | null {
    return this.current?.info.id ?? null;
  }

  private get current(): Running | undefined {
    return this.running[this.running.length - 1];
  }

  add(entry: Entry): void {
    const current = this.current;
    if (!current) return;
    current.pending.push(entry);
    if (this.refused === 0) this.keepTail(current); // else with the next try: a long tail is slow to write
    this.timer ??= setTimeout(() => void this.flush(), BATCH_MS);
  }

  private keepTail({ info, number, pending }: Running): void {
    keep(TAIL + info.id, pending.length === 0 ? null : JSON.stringify({ info, number, entries: pending }));
  }

  flush(): Promise<void> {
    if (this.timer) clearTimeout(this.timer);
    this.timer = null;
    this.flushing = this.flushing.then(() => this.flushAll());
    return this.flushing;
  }

  private async flushAll(): Promise<void> {
    const database = await this.store();
    let failed = false;
    for (const one of [...this.running]) {
      const entries = [...one.pending];
      if (entries.length === 0) continue;
      try {
        if (!database) throw new DOMException('no database', 'NotFoundError');
        await this.write(database, one.info, one.number, entries);
        one.info = { ...one.info, lines: one.info.lines + entries.length, last: entries[entries.length - 1]!.t };
        one.number++;
        one.pending.splice(0, entries.length);
      } catch {
        failed = true; // nothing is lost: it stays pending
      }
      this.keepTail(one);
    }
    if (failed) this.timer ??= setTimeout(() => void this.flush(), BATCH_MS);
    this.refused = failed ? this.running.reduce((sum, one) => sum + one.pending.length, 0) : 0;
    this.running = this.running.filter((one) => one === this.current || one.pending.length > 0);
  }

  private async store(): Promise<IDBDatabase | null> {
    if (this.database) return this.database;
    try {
      this.database = await openDatabase(); // a private window may have none: the session lives as long as the page
      this.database.onclose = this.database.onversionchange = () => {
        this.database?.close();
        this.database = null;
      };
    } catch {
      return null;
    }
    return this.database;
  }

  /** A batch that another page has already written with more lines stays as it is. */
  private async write(database: IDBDatabase, info: SessionInfo, number: number, entries: Entry[]): Promise<void> {
    if (entries.length === 0) return;
    const transaction = database.transaction(['sessions', 'batches'], 'readwrite');
    const done = complete(transaction);
    done.catch(() => undefined); // told below
    const batches = transaction.objectStore('batches');
    const there = await wrap<Batch | undefined>(batches.get([info.id, number]));
    if (!there || !Array.isArray(there.entries) || there.entries.length < entries.length) {
      batches.put({ session: info.id, number, entries });
      transaction.objectStore('sessions').put({ ...info, lines: info.lines + entries.length, last: entries[entries.length - 1]!.t });
    }
    await done;
  }

  async list(): Promise<SessionInfo[]> {
    const database = await this.store();
    const all = database ? await wrap<Partial<SessionInfo>[]>(database.transaction('sessions').objectStore('sessions').getAll()) : [];
    const good = all.filter(isInfo);
    this.bad.set('sessions', all.length - good.length);
    for (const { info, pending } of this.running) {
      if (!good.some((one) => one.id === info.id)) good.push({ ...info, lines: pending.length });
    }
    return good.sort((a, b) => b.id - a.id);
  }

  /** Also what is not yet in the database. */
  async read(id: number): Promise<Entry[]> {
    const database = await this.store();
    const range = IDBKeyRange.bound([id, -Infinity], [id, Infinity]);
    const batches = database ? await wrap<Partial<Batch>[]>(database.transaction('batches').objectStore('batches').getAll(range)) : [];
    const raw = batches.flatMap((batch) => (Array.isArray(batch.entries) ? batch.entries : [null]));
    const good = raw.filter(isEntry);
    this.bad.set(`batches of ${id}`, raw.length - good.length);
    return [...good, ...(this.running.find((one) => one.info.id === id)?.pending ?? [])].sort((a, b) => a.t - b.t);
  }

  async remove(id: number): Promise<void> {
    const database = await this.store();
    if (!database) return;
    const transaction = database.transaction(['sessions', 'batches'], 'readwrite');
    transaction.objectStore('batches').delete(IDBKeyRange.bound([id, -Infinity], [id, Infinity]));
    transaction.objectStore('sessions').delete(id);
    await complete(transaction);
    keep(TAIL + id, null);
  }

  /** Whether another tab is recording this session now. */
  async livesElsewhere(id: number): Promise<boolean> {
    const locks = await navigator.locks?.query().catch(() => undefined);
    return locks?.held?.some((lock) => lock.name === lockOf(id)) ?? false;
  }
}

/** The text of a session as the replay reads it: milliseconds, direction, line. */
export function writeSession(entries: Entry[]): string {
  return entries.map((entry) => `${Math.round(entry.t)} ${entry.out ? '>' : '<'} ${entry.text}\n`).join('');
}
