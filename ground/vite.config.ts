import { readFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';

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
      texts.push(`wasi-libc, in vehicle.js only (MIT and others)\n\nhttps://github.com/WebAssembly/wasi-libc, see its LICENSE: musl (MIT), cloudlibc (BSD-2-Clause), dlmalloc (CC0).`);
      this.emitFile({ type: 'asset', fileName: 'LICENCES.txt', source: `Plomada Ground: BSD-3-Clause, as Plomada itself. It contains:\n\n${texts.join('\n\n----\n\n')}\n` });
    },
  };
}

export default defineConfig({
  base: './',
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  build: {
    outDir: '../build-ground', emptyOutDir: false, target: 'es2022', modulePreload: false, assetsInlineLimit: 0,
    rollupOptions: { output: { format: 'iife', entryFileNames: 'ground.js', assetFileNames: 'ground.[ext]' } },
  },
  plugins: [classicScript(), licences()],
});
