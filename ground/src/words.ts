import { signal } from '@preact/signals';
import { keep, keptAs } from './keep';
import { en, es, type Words } from './texts';

export const language = signal(keptAs<'en' | 'es'>('language', (text) => (text === 'en' || text === 'es' ? text : null), navigator.language.startsWith('es') ? 'es' : 'en'));
export function w(): Words {
  return language.value === 'es' ? es : en;
}
/** A number in the reader's writing: of digits behind its mark so many, or as they are; NaN is a dash. Other text stays as it is. */
export function shown(value: number | string | undefined, digits?: number): string {
  if (value === undefined || Number.isNaN(value)) return '–';
  const text = typeof value === 'number' && digits !== undefined ? value.toFixed(digits) : String(value);
  return language.value === 'es' ? text.replace(/(\d)\.(?=\d)/g, '$1,') : text;
}
/** How old something is, in words; `age` in ms. */
export function ago(age: number): string {
  return w().ago(Math.floor(age / 1000));
}
/** The firmware's reason for a refusal, in the reader's language where its words are known. */
export function told(reason: string): string {
  const known = w().reasons.find(([pattern]) => pattern.test(reason));
  return known ? shown(reason.replace(known[0], known[1])) : reason;
}
export function switchLanguage(): void {
  language.value = language.value === 'es' ? 'en' : 'es';
  keep('language', language.value);
  document.documentElement.lang = language.value;
}
