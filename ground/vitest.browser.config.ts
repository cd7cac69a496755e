import { defineConfig } from 'vitest/config';
// Real browsers in real time, two at once: they wait most of the time. No second try: what failed once is not understood.
export default defineConfig({ test: { include: ['tests/browser/**/*.test.ts'], fileParallelism: true, maxWorkers: 2, minWorkers: 1, testTimeout: 60_000, hookTimeout: 60_000 } });
