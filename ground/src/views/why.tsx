import { useState } from 'preact/hooks';
import { saveFile, stamp } from '../plot';
import type { Recording } from '../protocol/logs';
import { w } from '../words';

/** What `plomada why` needs beside heights and thrust (docs/why.md). */
const NEEDED = ['roll_rad', 'pitch_rad', 'up_mps2', 'age_s'];
const tells = (recording: Recording): boolean => recording.csv !== null && NEEDED.every((column) => recording.columns[column]?.some((value) => !Number.isNaN(value)));

/** The page computes no answer: it saves the log, and shows the line that answers. */
export function Why({ recording }: { recording: Recording }) {
  const words = w();
  const [file, setFile] = useState<string | null>(null);
  const ask = (): void => {
    const name = `plomada-why-${stamp()}.csv`;
    saveFile(name, recording.csv!, 'text/csv');
    setFile(name);
  };
  if (!tells(recording)) return <div class="why"><button disabled aria-describedby="why-not">{words.whyButton}</button><p class="hint" id="why-not">{words.whyNot}</p></div>;
  return (
    <div class="why">
      <button onClick={ask}>{words.whyButton}</button>
      {file && <p role="status">{words.whySaved(file)}</p>}
      {file && <pre><code class="command">{`make why LOG="$HOME/Downloads/${file}"`}</code></pre>}
      {file && <p class="hint">{words.whyFolder}</p>}
    </div>
  );
}
