/** A way to the firmware: octets out, octets in, and a clock. Time is milliseconds; that of the simulated vehicle is its own. */
export interface Link {
  readonly kind: 'serial' | 'socket' | 'vehicle';
  readonly label: string;
  send(text: string): void;
  now(): number;
  close(): Promise<void>;
}

/** `lost`: the other side is gone, and why; a word of `words.ts`. */
export interface LinkEvents {
  octets(octets: Uint8Array): void;
  lost(reason: LostReason): void;
}

export type LostReason = 'unplugged' | 'serverGone' | 'broken' | 'halted';

/** Why a link could not be opened; each has its plain words. */
export type OpenFailure = 'noSerial' | 'noPort' | 'noneChosen' | 'busy' | 'otherTab' | 'denied' | 'noServer' | 'noVehicle' | 'failed';

export class OpenError extends Error {
  constructor(
    readonly failure: OpenFailure,
    readonly detail = '',
  ) {
    super(`${failure} ${detail}`);
  }
}

/** One tab at a time has the radio. Resolves to a release, or null when another tab has it. */
export async function claimRadio(name: string): Promise<(() => void) | null> {
  if (!navigator.locks) return () => undefined;
  return new Promise((resolve) => {
    void navigator.locks.request(`plomada-${name}`, { ifAvailable: true }, (lock) => {
      if (!lock) {
        resolve(null);
        return undefined;
      }
      return new Promise<void>((release) => resolve(release));
    });
  });
}
