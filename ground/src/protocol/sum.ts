/** The sum at the end of a line: CRC-16/CCITT-FALSE of the characters before its `*` (drivers/line_sum.h). */
export function lineSum(text: string): number {
  let sum = 0xffff;
  for (let i = 0; i < text.length; i++) {
    sum ^= (text.charCodeAt(i) & 0xff) << 8;
    for (let bit = 0; bit < 8; bit++) sum = ((sum & 0x8000) !== 0 ? (sum << 1) ^ 0x1021 : sum << 1) & 0xffff;
  }
  return sum;
}

/** A command line with its sum at the end, unless it has one already. */
export function withSum(text: string): string {
  return splitSum(text.toUpperCase()).right === null ? `${text}*${lineSum(text).toString(16).toUpperCase().padStart(4, '0')}` : text;
}

/** Splits `text*5A1F`. `right` is null where there is no sum. */
export function splitSum(line: string): { text: string; right: boolean | null } {
  const match = /^(.*)\*([0-9A-F]{4})$/.exec(line);
  if (!match) return { text: line, right: null };
  return { text: match[1]!, right: lineSum(match[1]!) === parseInt(match[2]!, 16) };
}
