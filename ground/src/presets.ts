import type { ParameterSet } from './protocol/parameters';

/** Of this firmware, as `plomada params` told when the page was built (ground/firmware.ts). */
declare const __DELIVERED__: ParameterSet;
export const delivered: ParameterSet = __DELIVERED__;
declare const __GROUPS__: Record<string, string>;
/** What each parameter is for; the names of the groups are `groups` of the texts. */
export const groupOf: Record<string, string> = __GROUPS__;

/** Sets of the seed document (chapters 6 and 7: its best flown values) and the laws as delivered. */
const seed = { RELEASE: 'FREE', KP: '0.015', KD: '0.008', USAT: '1', DSAT: '0', GRAV: '7' };
export const presets: Record<string, ParameterSet> = {
  pid: { ...seed, LAW: 'PID', KI: '0.01' },
  pd: { ...seed, LAW: 'PD', KI: '0' },
  pidt: { LAW: 'PIDT', PKP: '6', PKI: '1.4', PKD: '2.6' },
  est: { LAW: 'EST', POSK: '2.3', VELK: '8', VUP: '0.7', VDN: '1.1', TERRAIN: 'FOLLOW' },
};
