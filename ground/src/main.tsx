import { Component, render, type ComponentChildren } from 'preact';
import { useEffect, useRef } from 'preact/hooks';
import { effect, signal } from '@preact/signals';
import './style.css';
import { choosePort, knownPorts } from './link/serial';
import { BEAT_MS } from './freshness';
import { keep, kept, keptAs } from './keep';
import { beat, connectSerial, connectSocket, connectVehicle, diagnosis, dialog, disconnect, failure, link, live, lostReason, phase, restore, restored, seen, session, stop, stopState, unkept, unreadable, view, type View } from './store';
import { ConsoleView } from './views/console';
import { FlyView } from './views/fly';
import { ParametersView } from './views/parameters';
import { RecorderView } from './views/recorder';
import { ReplayView } from './views/replay';
import { WizardsView } from './views/wizards';
import { language, switchLanguage, w } from './words';

const ICONS: Record<View, string> = {
  fly: 'M3 17l6-6 4 4 8-9', parameters: 'M4 7h10M18 7h2M4 17h2M10 17h10M14 4v6M6 14v6', recorder: 'M12 3v11m0 0l-4-4m4 4l4-4M4 20h16', wizards: 'M4 12l4 4L20 5', console: 'M5 7l5 5-5 5M13 18h7', replay: 'M4 5v6h6M4 11a8 8 0 1 1 2 6',
};
const VIEWS = Object.keys(ICONS) as View[];
const known = signal(false);
const address = signal(kept('address') ?? 'ws://localhost:8124');

type Theme = 'light' | 'dark';
function preferred(): Theme {
  return keptAs<Theme>('theme', (text) => (text === 'light' || text === 'dark' ? text : null), matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
}
function setTheme(theme: Theme): void {
  document.documentElement.dataset.theme = theme;
}
setTheme(preferred());
document.documentElement.lang = language.value;
/** Nothing is green but while telemetry comes: style.css has the colours that say *well* under this attribute only. */
effect(() => {
  document.documentElement.dataset.live = live.value ? 'yes' : 'no';
});

function Logo() {
  return (
    <svg class="logo" viewBox="0 0 32 32" aria-hidden="true"><path d="M4 7h24M16 7v11" /><path class="bob" d="M10 18h12l-6 11z" /></svg>
  );
}

function Status() {
  const words = w();
  const bad = phase.value === 'lost' || (phase.value === 'open' && seen.value.kind === 'old');
  const text = bad ? words.lost : words[phase.value === 'opening' || phase.value === 'open' ? phase.value : 'idle'];
  return (
    <button class={`status ${bad ? 'bad' : live.value ? 'good' : ''}`} onClick={() => (dialog.value = true)} aria-haspopup="dialog">
      <i />
      <span><strong>{text}</strong><small>{link.value?.label === 'simulated vehicle' ? words.simTitle : link.value?.label ?? words.connect}</small></span>
    </button>
  );
}

function Stops() {
  const words = w();
  const open = phase.value === 'open';
  return (
    <div class="stops" role="group" aria-label="STOP, LAND">
      <button class={`land ${stopState.value.LAND}`} disabled={!open} title={words.landTitle} aria-keyshortcuts="L" onClick={() => void stop('LAND')}>
        {words.land}<small>{words.stopStates[stopState.value.LAND] || words.landHint}</small>
      </button>
      <button class={`stop ${stopState.value.STOP}`} disabled={!open} title={words.stopTitle} aria-keyshortcuts="Escape" onClick={() => void stop('STOP')}>
        {words.stop}<small>{words.stopStates[stopState.value.STOP] || words.stopHint}</small>
      </button>
    </div>
  );
}

function Banner() {
  const words = w();
  const texts: [string, string][] = [];
  if (phase.value === 'lost') texts.push(['bad', words.lostReasons[lostReason.value ?? 'broken']!]);
  if (stopState.value.STOP === 'unanswered' || stopState.value.LAND === 'unanswered') texts.push(['bad', words.stopUnanswered]);
  if (diagnosis.value) texts.push(['bad', words.diagnoses[diagnosis.value]!]);
  else if (phase.value === 'open' && seen.value.kind === 'old') texts.push(['bad', words.noTelemetry(Math.floor(seen.value.age / 1000).toString())]);
  if (restored.value && phase.value === 'idle') texts.push(['', words.restored(restored.value.lines)]);
  if (unkept.value > 0) texts.push(['bad', words.unkept(unkept.value)]);
  if (unreadable.value > 0) texts.push(['', words.unreadableStore(unreadable.value)]);
  return (
    <div role="alert" class="banners">
      {texts.map(([kind, text]) => (
        <p class={`banner ${kind}`} key={text.slice(0, 20)}>{text} {phase.value === 'lost' && <button onClick={() => (dialog.value = true)}>{words.reconnect}</button>}</p>
      ))}
    </div>
  );
}

async function openSerial(ask: boolean): Promise<void> {
  await connectSerial(async () => {
    const [first] = ask ? [] : await knownPorts();
    if (first) return first;
    return choosePort();
  });
  known.value = (await knownPorts()).length > 0;
}

function ConnectDialog() {
  const words = w();
  const sheet = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (dialog.value && !sheet.current?.open) sheet.current?.showModal();
    if (!dialog.value && sheet.current?.open) sheet.current.close();
  }, [dialog.value]);
  useEffect(() => void knownPorts().then((ports) => (known.value = ports.length > 0)), []);
  return (
    <dialog ref={sheet} class="sheet" aria-labelledby="connect-title" onClose={() => (dialog.value = false)}>
      <header><Logo /><div><h2 id="connect-title">Plomada Ground</h2><p>{words.tagline}</p></div><button class="quiet" onClick={() => (dialog.value = false)} aria-label={words.close}>×</button></header>
      <h3>{words.chooseLink}</h3>
      {failure.value && <p class="banner bad" role="alert">{words.failures[failure.value.why]} {failure.value.why === 'failed' ? failure.value.detail : ''}</p>}
      <div class="links">
        <section class="featured">
          <h4>{words.simTitle}</h4><p>{words.simText}</p>
          <button class="primary" autofocus onClick={() => void connectVehicle()}>{words.simGo}</button>
        </section>
        <section>
          <h4>{words.serialTitle}</h4><p>{words.serialText}</p>
          {known.value && <button class="primary" onClick={() => void openSerial(false)}>{words.serialAgain}</button>}
          <button onClick={() => void openSerial(true)}>{words.serialGo}</button>
        </section>
        <section>
          <h4>{words.socketTitle}</h4><p>{words.socketText} <code>make ground-fly</code></p>
          <label class="address">{words.socketAddress}<input value={address.value} onInput={(event) => (address.value = event.currentTarget.value)} /></label>
          <button onClick={() => { keep('address', address.value); void connectSocket(address.value); }}>{words.socketGo}</button>
        </section>
      </div>
      {(phase.value === 'open' || phase.value === 'opening') && <footer><button onClick={() => void disconnect()}>{words.disconnect}</button></footer>}
    </dialog>
  );
}

/** A view that cannot be drawn takes nothing else with it: STOP and LAND stay. */
class Fence extends Component<{ children: ComponentChildren }, { error: string | null }> {
  override state = { error: null };
  static override getDerivedStateFromError(error: unknown): { error: string } {
    return { error: String(error) };
  }
  override render() {
    return this.state.error === null ? this.props.children : <p class="banner bad" role="alert">{w().viewBroken} <code>{this.state.error}</code></p>;
  }
}

function App() {
  const words = w();
  const views = { fly: FlyView, parameters: ParametersView, recorder: RecorderView, wizards: WizardsView, console: ConsoleView, replay: ReplayView };
  const Shown = views[view.value];
  return (
    <>
      <header class="top">
        <h1 class="brand"><Logo /><strong>Plomada<span>Ground</span></strong></h1>
        <Status />
        <span class="spacer" />
        <button class="quiet icon" onClick={switchLanguage} lang={language.value === 'en' ? 'es' : 'en'}>{words.language}</button>
        <button class="quiet icon" aria-label={words.theme} title={words.theme} onClick={() => {
          const next: Theme = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
          keep('theme', next);
          setTheme(next);
        }}><svg viewBox="0 0 24 24" aria-hidden="true"><circle cx="12" cy="12" r="8" /><path d="M12 4a8 8 0 0 1 0 16z" class="half" /></svg></button>
        <Stops />
      </header>
      <nav class="tabs" aria-label="Plomada Ground">
        {VIEWS.map((name) => (
          <button key={name} class={view.value === name ? 'chosen' : ''} aria-current={view.value === name ? 'page' : undefined} onClick={() => (view.value = name)}>
            <svg viewBox="0 0 24 24" aria-hidden="true"><path d={ICONS[name]} /></svg><span>{words[name]}</span>
          </button>
        ))}
      </nav>
      <main><Banner /><Fence key={view.value}><Shown /></Fence></main>
      <ConnectDialog />
    </>
  );
}

window.addEventListener('keydown', (event) => {
  const element = event.target as HTMLElement;
  const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(element.tagName);
  if (event.key === 'Escape' && phase.value === 'open') void stop('STOP');
  else if (event.key.toLowerCase() === 'l' && !typing && !event.ctrlKey && !event.metaKey && !event.altKey && phase.value === 'open') void stop('LAND');
});
window.addEventListener('pagehide', () => {
  session.leave();
  void session.flush();
});
window.addEventListener('beforeunload', (event) => {
  if (phase.value === 'open' && seen.value.kind !== 'nothing' && seen.value.telemetry.state !== 'GROUND') event.preventDefault();
});

render(<App />, document.getElementById('app')!);
setInterval(beat, BEAT_MS);
void restore().catch((error: unknown) => console.error(error)); // what was kept is no condition for flying
