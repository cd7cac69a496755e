import { defineConfig } from 'vitest/config';
import { firmware } from './firmware';

export default defineConfig({ define: firmware(), test: { include: ['tests/unit/**/*.test.ts'] } });
