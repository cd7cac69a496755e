import type { ParameterSet } from './protocol/parameters';

/** Sets of the seed document (chapters 6 and 7: its best flown values) and the laws as delivered. A test holds `delivered`
 * against `plomada params`. */
export const delivered: ParameterSet = {
  KP: '0.015', KD: '0.008', KI: '0.01', USAT: '1', DSAT: '0', GRAV: '7', LAW: 'EST', RELEASE: 'FREE', PKP: '6', PKI: '1.4', PKD: '2.6', POSK: '2.3', VELK: '8', VUP: '0.7', VDN: '1.1', TERRAIN: 'FOLLOW', PLANT: 'THRUST', CRATE: '1', LINK: '0', SEL: 'NONE', SUM: 'OFF', IDLE: '15',
  IROLL: '-ROLL', IPITCH: 'PITCH', IDOWN: 'Z', IUNIT: '256', DF: '105', LF: '100', L: '220', D1: '115', L1: '98', D2: '107', L2: '105',
};

const seed = { RELEASE: 'FREE', KP: '0.015', KD: '0.008', USAT: '1', DSAT: '0', GRAV: '7' };
export const presets: Record<string, ParameterSet> = {
  pid: { ...seed, LAW: 'PID', KI: '0.01' },
  pd: { ...seed, LAW: 'PD', KI: '0' },
  pidt: { LAW: 'PIDT', PKP: '6', PKI: '1.4', PKD: '2.6' },
  est: { LAW: 'EST', POSK: '2.3', VELK: '8', VUP: '0.7', VDN: '1.1', TERRAIN: 'FOLLOW' },
};
