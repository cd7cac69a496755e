import { signal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { pickFiles, saveFile, stamp } from '../plot';
import { NothingToRead, readCsv, readLog, type Recording } from '../protocol/logs';
import { cancelDownload, command, download, downloadRecorder, phase } from '../store';
import { w } from '../words';
import { RecordingPlots } from './recording';

const compared = signal<Recording[]>([]);
const problem = signal<string | null>(null);
const fast = signal(false);

async function setRate(every: boolean): Promise<void> {
  fast.value = every;
  const outcome = await command(`#LOG RATE ${every ? 'FAST' : 'SLOW'}`);
  if (!outcome.ok) fast.value = !every;
}

async function compare(): Promise<void> {
  problem.value = null;
  for (const file of await pickFiles(true)) {
    try {
      compared.value = [...compared.value, ...readLog(await file.text(), file.name)];
    } catch (error) {
      problem.value = `${file.name}: ${error instanceof NothingToRead ? w().unreadable[error.why] : String(error)}`;
    }
  }
}

export function RecorderView() {
  const words = w();
  const d = download.value;
  const running = d.state === 'running' || d.state === 'repairing';
  const recording = useMemo(() => (d.csv ? readCsv(d.csv, words.recorder, 'console') : null), [d.csv]);
  return (
    <section class="card wide" aria-labelledby="recorder-title">
      <div class="head">
        <h2 id="recorder-title">{words.recorder}</h2>
        <button class="primary" disabled={phase.value !== 'open' || running} onClick={() => void downloadRecorder(null)}>{words.downloadAll}</button>
        <button disabled={phase.value !== 'open' || running} onClick={() => void downloadRecorder(20)}>{words.downloadLast}</button>
        {running && <button onClick={cancelDownload}>{words.cancel}</button>}
        <label class="check"><input type="checkbox" disabled={phase.value !== 'open' || running} checked={fast.value} onChange={(event) => void setRate(event.currentTarget.checked)} /> {words.rateFast}</label>
        <span class="spacer" />
        <button disabled={!d.csv} onClick={() => saveFile(`plomada-log-${stamp()}.csv`, d.csv, 'text/csv')}>{words.saveCsv}</button>
        <button onClick={() => void compare()}>{words.compareWith}</button>
        <button disabled={phase.value !== 'open' || running} onClick={() => void command('#LOG CLEAR')}>{words.clear}</button>
      </div>
      <p class="hint">{words.recorderText}</p>
      {running && (
        <div class="progress">
          <progress max={Math.max(1, d.expected)} value={d.received} aria-label={words.recorder} />
          <span role="status">{d.state === 'repairing' ? words.repairing : words.progress(d.received, d.expected)}</span>
        </div>
      )}
      {d.state === 'done' && <p class={`banner ${d.lost > 0 ? 'bad' : 'good'}`} role="status">{d.received === 0 ? words.noRecord : words.downloadDone(d.received, d.lost)}</p>}
      {d.state === 'failed' && <p class="banner bad" role="status">{words.downloadFailed}</p>}
      {problem.value && <p class="banner bad" role="alert">{words.cannotRead}: {problem.value}</p>}
      {recording ? <RecordingPlots recordings={[recording, ...compared.value]} /> : compared.value.length > 0 && <RecordingPlots recordings={compared.value} />}
    </section>
  );
}
