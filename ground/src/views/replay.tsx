import { signal } from '@preact/signals';
import { flyScenario } from '../link/vehicle';
import { pickFiles, saveFile } from '../plot';
import { NothingToRead, readCsv, readLog, type Recording } from '../protocol/logs';
import { w } from '../words';
import { RecordingPlots } from './recording';

export const replayed = signal<Recording[]>([]);
const problem = signal<string | null>(null);
const busy = signal(false);
const scenario = signal('est-60cm-ramp');
const seed = signal('1');
const results = signal<{ name: string; metrics: Record<string, unknown>; csv: string } | null>(null);
const SCENARIOS = ['est-60cm-ramp', 'pid-60cm-ramp', 'pd-60cm-ramp', 'pidt-60cm-ramp'];

export async function openFiles(files: File[]): Promise<void> {
  problem.value = null;
  for (const file of files) {
    try {
      replayed.value = [...replayed.value, ...readLog(await file.text(), file.name)];
    } catch (error) {
      problem.value = `${file.name}: ${error instanceof NothingToRead ? w().unreadable[error.why] : String(error)}`;
    }
  }
}

async function fly(): Promise<void> {
  busy.value = true;
  problem.value = null;
  await new Promise((done) => setTimeout(done, 30));
  try {
    const flight = await flyScenario([scenario.value, '--seed', seed.value, '--csv', '/flight.csv', '--json', '/flight.json']);
    const csv = flight.files.get('flight.csv') ?? '';
    results.value = { name: scenario.value, metrics: JSON.parse(flight.files.get('flight.json') ?? '{}') as Record<string, unknown>, csv };
    replayed.value = [readCsv(csv, `${scenario.value} · ${seed.value}`), ...replayed.value];
  } catch (error) {
    problem.value = (error as Error).message;
  }
  busy.value = false;
}

export function ReplayView() {
  const words = w();
  return (
    <section class="card wide" aria-labelledby="replay-title"
      onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => {
        event.preventDefault();
        void openFiles([...(event.dataTransfer?.files ?? [])]);
      }}>
      <div class="head">
        <h2 id="replay-title">{words.replay}</h2>
        <button class="primary" onClick={async () => openFiles(await pickFiles(true))}>{words.openFile}</button>
        <span class="spacer" />
        <label class="select">{words.flyScenario}
          <select value={scenario.value} onChange={(event) => (scenario.value = event.currentTarget.value)}>{SCENARIOS.map((name) => <option key={name}>{name}</option>)}</select>
        </label>
        <label class="select">{words.seed} <input class="short" inputMode="numeric" value={seed.value} onInput={(event) => (seed.value = event.currentTarget.value.replace(/\D/g, '') || '1')} /></label>
        <button disabled={busy.value} onClick={() => void fly()}>{busy.value ? words.flying : words.scenarioGo}</button>
      </div>
      <p class="hint">{words.replayText} {words.scenarioText}</p>
      {problem.value && <p class="banner bad" role="alert">{words.cannotRead}: {problem.value}</p>}
      {replayed.value.length > 0 && (
        <ul class="chips">{replayed.value.map((r, i) => (
          <li key={r.name + String(i)} class="chip">{r.name}<button aria-label={`${words.remove} ${r.name}`} onClick={() => (replayed.value = replayed.value.filter((other) => other !== r))}>×</button></li>
        ))}</ul>
      )}
      {replayed.value.length > 0 ? <RecordingPlots recordings={replayed.value} /> : <p class="empty drop">{words.dropHere} {words.openFile.toLowerCase()}.</p>}
      {results.value && (
        <details class="metrics">
          <summary>{results.value.name} · JSON</summary>
          <pre id="metrics">{JSON.stringify(results.value.metrics, null, 1)}</pre>
          <button onClick={() => saveFile(`${results.value!.name}.csv`, results.value!.csv, 'text/csv')}>{words.saveCsv}</button>
        </details>
      )}
    </section>
  );
}
