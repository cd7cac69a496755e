/** A number as it was typed, in the firmware's writing: the decimal mark may be a comma or a point, and nothing groups thousands. */
export function typed(text: string): string {
  return text.trim().replace(/^([+-]?\d*),(\d*)$/, '$1.$2');
}
