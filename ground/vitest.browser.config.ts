import { defineConfig } from 'vitest/config';
// Real browsers in real time, one after another. No second try: what failed once is not understood.
export default defineConfig({ test: { include: ['tests/browser/**/*.test.ts'], fileParallelism: false, testTimeout: 60_000, hookTimeout: 60_000 } });
