import { existsSync, readFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';
import { firmware } from './firmware';

// One classic script: a page that was opened from a disk may load no module.
function classicScript(): Plugin {
  return {
    name: 'classic-script',
    transformIndexHtml: { order: 'post', handler: (html) => html.replace(/<script type="module" crossorigin/g, '<script defer').replace(/ crossorigin/g, '') },
  };
}

// What the bundle contains, with each licence's full text.
const SHIPPED = ['preact', '@preact/signals', '@preact/signals-core', 'uplot'];
function licences(): Plugin {
  return {
    name: 'licences',
    generateBundle(_options, bundle) {
      const seen = new Set<string>();
      for (const chunk of Object.values(bundle)) {
        for (const module of chunk.type === 'chunk' ? chunk.moduleIds : []) {
          const match = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(module);
          if (match?.[1]) seen.add(match[1]);
        }
      }
      for (const name of seen) {
        if (!SHIPPED.includes(name)) this.error(`${name} is in the bundle and not in the list of licences`);
      }
      const texts = SHIPPED.map((name) => {
        const about = JSON.parse(readFileSync(`node_modules/${name}/package.json`, 'utf8')) as { version: string; license: string };
        return `${name} ${about.version} (${about.license})\n\n${readFileSync(`node_modules/${name}/LICENSE`, 'utf8')}`;
      });
      const libc = '/usr/share/doc/wasi-libc/copyright';
      if (!existsSync(libc)) this.error(`${libc} is missing, and vehicle.js contains wasi-libc`);
      texts.push(`wasi-libc, in vehicle.js only\n\n${readFileSync(libc, 'utf8')}`);
      texts.push(`compiler-rt builtins of LLVM, in vehicle.js only (Apache-2.0 WITH LLVM-exception, which asks for no notice in what was compiled)`);
      this.emitFile({ type: 'asset', fileName: 'LICENCES.txt', source: `Plomada Ground and the vehicle in vehicle.js:\n\n${readFileSync('../LICENSE', 'utf8')}\n\n----\n\n${texts.join('\n\n----\n\n')}\n` });
    },
  };
}

export default defineConfig({
  base: './',
  define: firmware(),
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  build: {
    outDir: '../build-ground', emptyOutDir: false, target: 'es2022', modulePreload: false, assetsInlineLimit: 0,
    rollupOptions: { output: { format: 'iife', entryFileNames: 'ground.js', assetFileNames: 'ground.[ext]' } },
  },
  plugins: [classicScript(), licences()],
});
