/** What this browser keeps of the operator's choices between two visits. A browser may refuse to keep anything, and anything may
 * stand there: what cannot be read, or is no sense, counts as not kept. */
const PREFIX = 'plomada.';

export function kept(name: string): string | null {
  try {
    return localStorage.getItem(PREFIX + name);
  } catch {
    return null;
  }
}

/** What `sense` makes of the text that was kept; null, or an error: no sense. */
export function keptAs<T>(name: string, sense: (text: string) => T | null, otherwise: T): T {
  const text = kept(name);
  try {
    return text === null ? otherwise : (sense(text) ?? otherwise);
  } catch {
    return otherwise;
  }
}

/** null forgets it. False: the browser refuses. */
export function keep(name: string, text: string | null): boolean {
  try {
    if (text === null) localStorage.removeItem(PREFIX + name);
    else localStorage.setItem(PREFIX + name, text);
    return true;
  } catch {
    return false;
  }
}

/** The names that begin so. */
export function keptNames(begin: string): string[] {
  try {
    return Object.keys(localStorage).filter((name) => name.startsWith(PREFIX + begin)).map((name) => name.slice(PREFIX.length));
  } catch {
    return [];
  }
}
