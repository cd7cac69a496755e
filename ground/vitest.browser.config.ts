import { defineConfig } from 'vitest/config';
// Real browsers in real time: a machine that is busy for a moment gets a second try, and vitest prints that it did.
export default defineConfig({ test: { include: ['tests/browser/**/*.test.ts'], fileParallelism: false, testTimeout: 60_000, hookTimeout: 60_000, retry: 1 } });
