import { signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { pickFiles, saveFile, stamp } from '../plot';
import { delivered, presets } from '../presets';
import { differences, objection, parseSet, same, writeSet, type Difference, type ParameterSet } from '../protocol/parameters';
import { command, heardAny, loading, ofThisVehicle, parameters, phase, readParameters, seen, stored } from '../store';
import { ago, told, w } from '../words';

const edits = ofThisVehicle<ParameterSet>({});
const file = signal<{ name: string; set: ParameterSet } | null>(null);
const confirming = ofThisVehicle<Difference[] | null>(null);
const message = ofThisVehicle<{ text: string; bad: boolean } | null>(null);

function current(): ParameterSet {
  return Object.fromEntries(parameters.value.map((p) => [p.name, p.value]));
}

function propose(set: ParameterSet): void {
  const now = current();
  edits.value = Object.fromEntries(Object.entries(set).filter(([name, value]) => name !== 'SETR' && name in now && !same(now[name], value)));
  message.value = Object.keys(edits.value).length === 0 ? { text: w().nothingDiffers, bad: false } : null;
}

async function write(list: Difference[]): Promise<void> {
  confirming.value = null;
  let done = 0;
  for (const { name, to } of list) {
    const outcome = await command(`#${name} ${to}`);
    if (!outcome.ok) {
      message.value = { text: `${w().refused}: ${name} ${to}: ${outcome.silent ? w().noAnswer : told(outcome.reason)}`, bad: true };
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
  if (text !== '#SAVE') await readParameters();
  if (text !== '#DEFAULTS') stored.value = current();
  message.value = { text: text === '#SAVE' ? w().savedOk : outcome.lines[0]?.text ?? '', bad: false };
}

async function load(): Promise<void> {
  const [chosen] = await pickFiles();
  if (!chosen) return;
  file.value = { name: chosen.name, set: parseSet(await chosen.text()) };
  propose(file.value.set);
}

export function ParametersView() {
  const words = w();
  useEffect(() => {
    if (phase.value === 'open' && heardAny.value && parameters.value.length === 0) void readParameters();
  }, [phase.value, heardAny.value]);
  const rows = parameters.value.filter((p) => p.name !== 'SETR');
  const pending = differences(current(), edits.value);
  const wrong = rows.some((p) => p.name in edits.value && objection(p, edits.value[p.name]!) !== null);
  const open = phase.value === 'open';
  return (
    <section class="card wide" aria-labelledby="parameters-title">
      <div class="head">
        <h2 id="parameters-title">{words.parameters}</h2>
        <button disabled={!open || loading.value} onClick={() => void readParameters()}>{loading.value ? words.reading : words.read}</button>
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
        <button disabled={rows.length === 0} onClick={() => saveFile(`plomada-${stamp()}.set`, writeSet(current()))}>{words.saveFile}</button>
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
            <tbody>{confirming.value.map((d) => (<tr key={d.name}><th scope="row">{d.name}</th><td>{d.from}</td><td><strong>{d.to}</strong></td></tr>))}</tbody></table>
          <div class="row"><button class="primary" onClick={() => void write(confirming.value!)}>{words.writeNow}</button><button onClick={() => (confirming.value = null)}>{words.cancel}</button></div>
        </div>
      )}
      {rows.length === 0 ? <p class="empty">{loading.value ? words.reading : words.notRead}</p> : (
        <div class="scroll">
          <table class="parameters">
            <thead><tr><th>{words.name}</th><th>{words.value}</th><th>{words.unit}</th><th>{words.limits}</th><th>{words.delivered}</th><th>{words.meaning}</th><td /></tr></thead>
            <tbody>
              {rows.map((p) => {
                const text = edits.value[p.name] ?? p.value;
                const problem = p.name in edits.value ? objection(p, text) : null;
                const changed = p.name in edits.value && !same(text, p.value);
                const set = (value: string): void => {
                  const next = { ...edits.value, [p.name]: value };
                  if (same(value, p.value)) delete next[p.name];
                  edits.value = next;
                };
                return (
                  <tr key={p.name} data-parameter={p.name} class={changed ? 'changed' : ''}>
                    <th scope="row">{p.name}</th>
                    <td>
                      {p.choices ? (
                        <select aria-label={p.name} value={text} onChange={(event) => set(event.currentTarget.value)}>{p.choices.map((choice) => (<option key={choice}>{choice}</option>))}</select>
                      ) : (
                        <input aria-label={p.name} aria-invalid={problem !== null} inputMode="decimal" value={text} onInput={(event) => set(event.currentTarget.value)} />
                      )}
                      {problem && <em class="problem" role="alert">{words.objections[problem]}</em>}
                    </td>
                    <td>{p.unit === '-' ? '' : p.unit}</td>
                    <td class="quiet-text">{p.choices ? '' : `${p.minimum} … ${p.maximum}`}</td>
                    <td class="quiet-text">{delivered[p.name] ?? ''}</td>
                    <td class="meaning">{words.meanings[p.name] ?? <span lang="en">{p.meaning}</span>}</td>
                    <td class="tags">
                      {changed && <span class="tag accent">{words.tagChanged}</span>}
                      {stored.value && !same(stored.value[p.name], p.value) && <span class="tag">{words.tagUnstored}</span>}
                      {file.value && p.name in file.value.set && !same(file.value.set[p.name], p.value) && <span class="tag" title={file.value.name}>{words.tagFile}</span>}
                    </td>
                  </tr>
                );
              })}
            </tbody>
          </table>
        </div>
      )}
      {pending.length > 0 && <button class="quiet" onClick={() => (edits.value = {})}>{words.discard}</button>}
    </section>
  );
}
