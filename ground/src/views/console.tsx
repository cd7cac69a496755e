import { signal } from '@preact/signals';
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { keep, keptAs } from '../keep';
import { saveFile } from '../plot';
import { ALIVE, consoleLines, phase, sendRaw, session, setSums, sums } from '../store';
import { writeSession, type SessionInfo } from '../session';
import { language, w } from '../words';

const typed = signal('');
const telemetry = signal(false);
const history = keptAs<string[]>('history', (text) => (JSON.parse(text) as unknown[]).filter((line) => typeof line === 'string'), []);
let place = history.length;
const sessions = signal<SessionInfo[]>([]);

function send(): void {
  const text = typed.value.trim();
  if (text === '' || phase.value !== 'open') return;
  if (history[history.length - 1] !== text) history.push(text);
  history.splice(0, Math.max(0, history.length - 100));
  keep('history', JSON.stringify(history));
  place = history.length;
  sendRaw(text.startsWith('#') ? text : `#${text}`);
  typed.value = '';
}

function onKey(event: KeyboardEvent): void {
  if (event.key === 'Enter') send();
  if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
  event.preventDefault();
  place = Math.max(0, Math.min(history.length, place + (event.key === 'ArrowUp' ? -1 : 1)));
  typed.value = history[place] ?? '';
}

async function save(info: SessionInfo): Promise<void> {
  await session.flush();
  saveFile(`plomada-session-${new Date(info.id).toISOString().slice(0, 19).replace(/[:T]/g, '-')}.txt`, writeSession(await session.read(info.id)));
}

export function ConsoleView() {
  const words = w();
  const end = useRef<HTMLDivElement>(null);
  const shown = consoleLines.value.filter((line) => telemetry.value || !(/^(alt|mf):/.test(line.text) || line.text.startsWith(ALIVE) || /^OK PING alive/i.test(line.text))).slice(-500);
  useLayoutEffect(() => void (end.current!.scrollTop = end.current!.scrollHeight), []);
  useEffect(() => {
    const list = end.current!;
    if (list.scrollHeight - list.scrollTop - list.clientHeight < 200) list.scrollTop = list.scrollHeight;
  }, [shown.length, shown[shown.length - 1]]);
  const list = async (): Promise<void> => {
    await session.flush();
    sessions.value = await session.list();
  };
  useEffect(() => void list(), []);
  return (
    <div class="two">
      <section class="card wide console" aria-labelledby="console-title">
        <div class="head">
          <h2 id="console-title">{words.console}</h2>
          <span class="spacer" />
          <label class="check" title={words.sumsHint}><input type="checkbox" checked={sums.value} onChange={(event) => setSums(event.currentTarget.checked)} /> {words.sums}</label>
          <label class="check"><input type="checkbox" checked={telemetry.value} onChange={(event) => (telemetry.value = event.currentTarget.checked)} /> {words.showTelemetry}</label>
        </div>
        <div class="lines" ref={end} role="log" tabIndex={0} aria-label={words.console}>
          {shown.map((line, i) => (
            <div key={`${line.t}${i}`} class={line.out ? 'out' : line.text.startsWith('ERR') ? 'err' : line.text.startsWith('OK') ? 'ok' : ''}>
              <time>{new Date(line.t).toISOString().slice(11, 23)}</time><span>{line.out ? '›' : ' '}</span><code>{line.text}</code>
            </div>
          ))}
        </div>
        <div class="prompt">
          <span aria-hidden="true">›</span>
          <input id="command" aria-label={words.typeCommand} placeholder={words.typeCommand} value={typed.value} maxLength={sums.value ? 27 : 32} autocomplete="off" spellcheck={false} autocapitalize="characters" onInput={(event) => (typed.value = event.currentTarget.value)} onKeyDown={onKey} disabled={phase.value !== 'open'} />
          <button class="primary" onClick={send} disabled={phase.value !== 'open'}>{words.send}</button>
        </div>
      </section>
      <section class="card sessions" aria-labelledby="sessions-title">
        <h2 id="sessions-title">{words.sessions}</h2>
        <p class="hint">{words.sessionsText} <button class="quiet" onClick={() => void list()}>↻</button></p>
        <ul>
          {sessions.value.map((info) => (
            <li key={info.id}>
              <span><strong>{new Date(info.id).toLocaleString(language.value)}</strong><br /><small>{info.link} · {info.lines} {words.lines}</small></span>
              <button onClick={() => void save(info)}>{words.saveLog}</button>
              <button class="quiet" disabled={info.id === session.id} onClick={async () => { await session.remove(info.id); await list(); }}>{words.deleteLog}</button>
            </li>
          ))}
        </ul>
      </section>
    </div>
  );
}
