/** What plomada.wasm asks of its machine: files in memory, standard output, a clock that stands still. */
export class Wasi {
  memory!: WebAssembly.Memory;
  readonly files = new Map<string, Uint8Array>();
  output = '';
  private open = new Map<number, { path: string; at: number; octets: number[] | null }>();
  private next = 4;

  private view(): DataView {
    return new DataView(this.memory.buffer);
  }

  private text(at: number, size: number): string {
    return new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, size));
  }

  imports(): WebAssembly.ModuleImports {
    const BADF = 8, NOENT = 44, NOSYS = 52, OK = 0;
    const calls: Record<string, (...args: number[]) => number> = {
      fd_write: (fd, iovs, count, written) => {
        const view = this.view();
        let total = 0;
        for (let i = 0; i < count!; i++) {
          const at = view.getUint32(iovs! + 8 * i, true);
          const size = view.getUint32(iovs! + 8 * i + 4, true);
          const octets = new Uint8Array(this.memory.buffer, at, size);
          total += size;
          if (fd! <= 2) this.output += new TextDecoder().decode(octets);
          else this.open.get(fd!)?.octets?.push(...octets);
        }
        view.setUint32(written!, total, true);
        return fd! <= 2 || this.open.has(fd!) ? OK : BADF;
      },
      fd_read: (_fd, _iovs, _count, read) => (this.view().setUint32(read!, 0, true), OK),
      fd_close: (fd) => {
        const file = this.open.get(fd!);
        if (file?.octets) this.files.set(file.path, new Uint8Array(file.octets));
        return this.open.delete(fd!) ? OK : BADF;
      },
      fd_seek: (_fd, _low, _whence, result) => (this.view().setBigUint64(result!, 0n, true), OK),
      fd_fdstat_get: (fd, at) => {
        const view = this.view();
        for (let i = 0; i < 24; i++) view.setUint8(at! + i, 0);
        view.setUint8(at!, fd! <= 2 ? 2 : fd! === 3 ? 3 : 4);
        view.setBigUint64(at! + 8, ~0n & 0x1fffffffn, true);
        view.setBigUint64(at! + 16, ~0n & 0x1fffffffn, true);
        return fd! <= 3 || this.open.has(fd!) ? OK : BADF;
      },
      fd_fdstat_set_flags: () => OK,
      fd_sync: () => OK,
      fd_prestat_get: (fd, at) => {
        if (fd !== 3) return BADF;
        this.view().setUint32(at!, 0, true);
        this.view().setUint32(at! + 4, 1, true);
        return OK;
      },
      fd_prestat_dir_name: (fd, at) => {
        if (fd !== 3) return BADF;
        this.view().setUint8(at!, 47);
        return OK;
      },
      path_open: (_dir, _look, path, size, create, _rights, _inherit, _flags, result) => {
        const name = this.text(path!, size!);
        if ((create! & 1) === 0) return NOENT;
        this.open.set(this.next, { path: name, at: 0, octets: [] });
        this.view().setUint32(result!, this.next++, true);
        return OK;
      },
      path_filestat_get: () => NOENT,
      path_unlink_file: () => NOENT,
      path_rename: () => NOENT,
      path_remove_directory: () => NOENT,
      clock_time_get: (_id, _precision, at) => (this.view().setBigUint64(at!, 0n, true), OK),
      environ_sizes_get: (a, b) => (this.view().setUint32(a!, 0, true), this.view().setUint32(b!, 0, true), OK),
      environ_get: () => OK,
      args_sizes_get: (a, b) => (this.view().setUint32(a!, 0, true), this.view().setUint32(b!, 0, true), OK),
      args_get: () => OK,
      proc_exit: (status) => {
        throw new Error(`the vehicle's program ended with status ${status}`);
      },
    };
    return new Proxy(calls, { get: (all, name: string) => all[name] ?? (() => NOSYS), has: () => true }) as unknown as WebAssembly.ModuleImports;
  }
}
