import { signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { pickFiles, saveFile, stamp } from '../plot';
import { delivered, groupOf, presets } from '../presets';
import { typed } from '../protocol/decimal';
import { differences, objection, parseSet, same, writeSet, type Difference, type Parameter, type ParameterSet } from '../protocol/parameters';
import { command, heardAny, loading, ofThisVehicle, parameters, phase, readParameters, seen, stored, valuesOf } from '../store';
import { ago, shown, told, w } from '../words';

const edits = ofThisVehicle<ParameterSet>({}); // as they stand in the fields, in the reader's writing
const file = signal<{ name: string; set: ParameterSet } | null>(null);
const confirming = ofThisVehicle<Difference[] | null>(null);
const message = ofThisVehicle<{ text: string; bad: boolean } | null>(null);
const wanted = signal(''); // what is searched for
const shows = signal<'all' | 'changed' | 'moved' | 'unstored'>('all');
const turned = signal<Record<string, boolean>>({}); // groups that were opened or closed by hand

const current = (): ParameterSet => valuesOf(parameters.value);
const unwritten = (): Difference[] => differences(current(), Object.fromEntries(Object.entries(edits.value).map(([name, text]) => [name, typed(text)])));

function propose(set: ParameterSet): void {
  const now = current();
  edits.value = Object.fromEntries(Object.entries(set).filter(([name, value]) => name !== 'SETR' && name in now && !same(now[name], value)).map(([name, value]) => [name, shown(value)]));
  message.value = Object.keys(edits.value).length === 0 ? { text: w().nothingDiffers, bad: false } : null;
}

async function read(): Promise<void> {
  message.value = (await readParameters()) ? null : { text: w().notAllRead, bad: true };
}

async function write(list: Difference[]): Promise<void> {
  confirming.value = null;
  let done = 0;
  for (const { name, to } of list) {
    const outcome = await command(`#${name} ${to}`);
    if (!outcome.ok) {
      const why = `${w().refused}: ${name} ${shown(to)}: ${outcome.silent ? w().noAnswer : told(outcome.reason)}`;
      message.value = { text: done > 0 ? `${why}. ${w().writtenBefore(done)}` : why, bad: true };
      return;
    }
    done++;
    const rest = { ...edits.value };
    delete rest[name];
    edits.value = rest;
  }
  message.value = { text: w().written(done), bad: false };
}

async function storage(text: '#SAVE' | '#LOAD' | '#DEFAULTS'): Promise<void> {
  const outcome = await command(text);
  if (!outcome.ok) {
    message.value = { text: `${text.slice(1)}: ${outcome.silent ? w().noAnswer : told(outcome.reason)}`, bad: true };
    return;
  }
  const whole = text === '#SAVE' || (await readParameters());
  if (text !== '#DEFAULTS') stored.value = whole ? current() : null;
  const left = unwritten().length;
  if (!whole) message.value = { text: w().notAllRead, bad: true };
  else if (text !== '#SAVE') message.value = { text: outcome.lines[0]?.text ?? '', bad: false };
  else message.value = left > 0 ? { text: w().storedWithout(left), bad: true } : { text: w().savedOk, bad: false };
}

async function load(): Promise<void> {
  const [chosen] = await pickFiles();
  if (!chosen) return;
  file.value = { name: chosen.name, set: parseSet(await chosen.text()) };
  propose(file.value.set);
}

function save(): void {
  saveFile(`plomada-${stamp()}.set`, writeSet(current()));
  const left = unwritten().length;
  message.value = left > 0 ? { text: w().savedWithout(left), bad: true } : null;
}

const isChanged = (p: Parameter): boolean => p.name in edits.value && !same(typed(edits.value[p.name]!), p.value);
const isMoved = (p: Parameter): boolean => delivered[p.name] !== undefined && !same(delivered[p.name], p.value);
const isUnstored = (p: Parameter): boolean => stored.value !== null && !same(stored.value[p.name], p.value);

const plain = (text: string): string => text.normalize('NFD').replace(/\p{M}/gu, '').toLowerCase();
function isFound(p: Parameter): boolean {
  const kinds = { all: () => true, changed: isChanged, moved: isMoved, unstored: isUnstored };
  if (!kinds[shows.value](p)) return false;
  const meaning = w().meanings[p.name] ?? p.meaning;
  return plain(wanted.value).trim().split(/\s+/).every((part) => plain(`${p.name} ${p.unit} ${meaning}`).includes(part));
}

function Row({ parameter: p }: { parameter: Parameter }) {
  const words = w();
  const text = edits.value[p.name] ?? (p.choices ? p.value : shown(p.value));
  const problem = p.name in edits.value ? objection(p, text) : null;
  const set = (value: string): void => {
    const next = { ...edits.value, [p.name]: value };
    if (same(typed(value), p.value)) delete next[p.name];
    edits.value = next;
  };
  return (
    <li data-parameter={p.name} class={isChanged(p) ? 'changed' : ''}>
      <strong>{p.name}</strong>
      <span class="field">
        {p.choices ? (
          <select aria-label={p.name} value={text} onChange={(event) => set(event.currentTarget.value)}>{p.choices.map((choice) => (<option key={choice}>{choice}</option>))}</select>
        ) : (
          <input aria-label={p.name} aria-invalid={problem !== null} inputMode="decimal" value={text} onInput={(event) => set(event.currentTarget.value)} />
        )}
        {problem && <em class="problem" role="alert">{words.objections[problem]}</em>}
      </span>
      <span class="limits">{p.choices ? '' : `${shown(p.minimum)} … ${shown(p.maximum)}${p.unit === '-' ? '' : ` ${p.unit}`}`}</span>
      <span class="delivered">{delivered[p.name] === undefined ? '' : `${words.delivered}: ${shown(delivered[p.name]!)}`}</span>
      <span class="meaning">{words.meanings[p.name] ?? <span lang="en">{p.meaning}</span>}</span>
      <span class="tags">
        {isChanged(p) && <span class="tag accent">{words.tagChanged}</span>}
        {isMoved(p) && <span class="tag">{words.tagDefault}</span>}
        {isUnstored(p) && <span class="tag">{words.tagUnstored}</span>}
        {file.value && p.name in file.value.set && !same(file.value.set[p.name], p.value) && <span class="tag" title={file.value.name}>{words.tagFile}</span>}
      </span>
    </li>
  );
}

/** The law that is set, or will be; of the groups of laws only its own are open. */
function Groups({ rows }: { rows: Parameter[] }) {
  const words = w();
  const law = rows.find((p) => p.name === 'LAW');
  const chosen = law ? edits.value.LAW ?? law.value : '';
  const filtered = wanted.value.trim() !== '' || shows.value !== 'all';
  const found = rows.filter(isFound);
  if (found.length === 0) return <p class="empty">{words.nothingFound}</p>;
  const known = Object.keys(words.groups);
  const of = (p: Parameter): string => (known.includes(groupOf[p.name] ?? '') ? groupOf[p.name]! : 'other');
  return (
    <>
      {known.map((group) => {
        const members = found.filter((p) => of(p) === group);
        if (members.length === 0) return null;
        const laws = (law?.choices ?? []).filter((name) => group.toUpperCase().split('-').includes(name));
        const used = laws.length === 0 || laws.includes(chosen);
        const open = filtered || (turned.value[group] ?? used);
        return (
          <details key={group} data-group={group} class="group" open={open} onToggle={(event) => {
            if (event.currentTarget.open !== open) turned.value = { ...turned.value, [group]: event.currentTarget.open };
          }}>
            <summary><h3>{words.groups[group]}</h3> <small>{members.length}{used ? '' : ` · ${words.unusedGroup(chosen)}`}</small></summary>
            {open && <ul class="parameters">{members.map((p) => (<Row key={p.name} parameter={p} />))}</ul>}
          </details>
        );
      })}
    </>
  );
}

export function ParametersView() {
  const words = w();
  useEffect(() => {
    if (phase.value === 'open' && heardAny.value && parameters.value.length === 0) void read();
  }, [phase.value, heardAny.value]);
  const rows = parameters.value.filter((p) => p.name !== 'SETR');
  const pending = unwritten();
  const wrong = rows.some((p) => p.name in edits.value && objection(p, edits.value[p.name]!) !== null);
  const open = phase.value === 'open';
  const counts = { all: rows.length, changed: rows.filter(isChanged).length, moved: rows.filter(isMoved).length, unstored: stored.value ? rows.filter(isUnstored).length : '?' };
  return (
    <section class="card wide" aria-labelledby="parameters-title">
      <div class="head">
        <h2 id="parameters-title">{words.parameters}</h2>
        <button disabled={!open || loading.value} onClick={() => void read()}>{loading.value ? words.reading : words.read}</button>
        <label class="select">{words.presets}
          <select value="" onChange={(event) => {
            const name = event.currentTarget.value;
            if (name) propose(presets[name]!);
            event.currentTarget.value = '';
          }}>
            <option value="">…</option>
            {Object.keys(presets).map((name) => (<option key={name} value={name}>{words.presetNames[name]}</option>))}
          </select>
        </label>
        <button disabled={rows.length === 0} onClick={() => void load()}>{words.openFile}</button>
        <button disabled={rows.length === 0} onClick={save}>{words.saveFile}</button>
        <span class="spacer" />
        <button disabled={!open} onClick={() => void storage('#DEFAULTS')}>{words.defaults}</button>
        <button disabled={!open} onClick={() => void storage('#LOAD')}>{words.loadStored}</button>
        <button disabled={!open} onClick={() => void storage('#SAVE')}>{words.storeThem}</button>
        <button class="primary" disabled={!open || pending.length === 0 || wrong} onClick={() => (confirming.value = pending)}>{words.writeChanges}{pending.length > 0 ? ` (${pending.length})` : ''}</button>
      </div>
      {rows.length > 0 && seen.value.kind === 'old' && <p class="banner bad">{words.asRead(ago(seen.value.age))}</p>}
      {message.value && <p class={`banner ${message.value.bad ? 'bad' : 'good'}`} role="status">{message.value.text}</p>}
      {confirming.value && (
        <div class="confirm" role="alertdialog" aria-label={words.confirmWrite}>
          <h3>{words.confirmWrite}</h3>
          <table><thead><tr><th>{words.name}</th><th>{words.from}</th><th>{words.to}</th></tr></thead>
            <tbody>{confirming.value.map((d) => (<tr key={d.name}><th scope="row">{d.name}</th><td>{shown(d.from)}</td><td><strong>{shown(d.to)}</strong></td></tr>))}</tbody></table>
          <div class="row"><button class="primary" onClick={() => void write(confirming.value!)}>{words.writeNow}</button><button onClick={() => (confirming.value = null)}>{words.cancel}</button></div>
        </div>
      )}
      {rows.length === 0 ? <p class="empty">{loading.value ? words.reading : words.notRead}</p> : (
        <>
          <div class="row" role="search">
            <input type="search" aria-label={words.search} placeholder={words.search} value={wanted.value} onInput={(event) => (wanted.value = event.currentTarget.value)} />
            {(['all', 'changed', 'moved', 'unstored'] as const).map((name) => (
              <button key={name} class={`chip ${shows.value === name ? 'chosen' : ''}`} aria-pressed={shows.value === name} disabled={counts[name] === '?'} onClick={() => (shows.value = name)}>{words.shows[name]} ({counts[name]})</button>
            ))}
          </div>
          {stored.value === null && <p class="hint">{words.storedUnknown}</p>}
          <Groups rows={rows} />
        </>
      )}
      {pending.length > 0 && <button class="quiet" onClick={() => (edits.value = {})}>{words.discard}</button>}
    </section>
  );
}
