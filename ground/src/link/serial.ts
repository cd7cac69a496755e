import { keep, keptAs } from '../keep';
import { claimRadio, OpenError, type Link, type LinkEvents } from './link';

const RATE = 9600;
const REMEMBERED = 'port';

interface PortName {
  vendor?: number;
  product?: number;
}

function nameOf(port: SerialPort): PortName {
  const info = port.getInfo();
  const name: PortName = {};
  if (info.usbVendorId !== undefined) name.vendor = info.usbVendorId;
  if (info.usbProductId !== undefined) name.product = info.usbProductId;
  return name;
}

function remembered(): PortName | null {
  return keptAs<PortName | null>(REMEMBERED, (text) => JSON.parse(text) as PortName | null, null);
}

/** The ports that this page may open already; the one used last is the first. */
export async function knownPorts(): Promise<SerialPort[]> {
  if (!navigator.serial) return [];
  const last = remembered();
  const ports = await navigator.serial.getPorts();
  const isLast = (port: SerialPort): boolean => last !== null && nameOf(port).vendor === last.vendor && nameOf(port).product === last.product;
  return [...ports.filter(isLast), ...ports.filter((port) => !isLast(port))];
}

/** The browser's own list; from a click only. */
export async function choosePort(): Promise<SerialPort> {
  if (!navigator.serial) throw new OpenError(isSecureContext ? 'noSerial' : 'denied');
  try {
    return await navigator.serial.requestPort();
  } catch (error) {
    throw new OpenError((error as DOMException).name === 'SecurityError' ? 'denied' : 'noneChosen');
  }
}

function openFailure(error: DOMException): OpenError {
  if (error.name === 'InvalidStateError' || error.name === 'NetworkError') return new OpenError('busy', error.message);
  return new OpenError('failed', error.message);
}

export async function openSerial(port: SerialPort, events: LinkEvents): Promise<Link> {
  const release = await claimRadio('serial');
  if (!release) throw new OpenError('otherTab');
  try {
    await port.open({ baudRate: RATE, bufferSize: 4096 });
  } catch (error) {
    release();
    throw openFailure(error as DOMException);
  }
  keep(REMEMBERED, JSON.stringify(nameOf(port)));
  return new SerialLink(port, events, release);
}

class SerialLink implements Link {
  readonly kind = 'serial';
  readonly label: string;
  private closing = false;
  private reader: ReadableStreamDefaultReader<Uint8Array> | null = null;
  private readonly reading: Promise<void>;
  private writing: Promise<void> = Promise.resolve();

  constructor(
    private readonly port: SerialPort,
    private readonly events: LinkEvents,
    private readonly release: () => void,
  ) {
    const { vendor, product } = nameOf(port);
    const hex = (n: number): string => n.toString(16).padStart(4, '0');
    this.label = vendor === undefined ? 'serial port' : `USB ${hex(vendor)}:${hex(product ?? 0)}`;
    this.reading = this.read();
  }

  now(): number {
    return performance.timeOrigin + performance.now();
  }

  send(text: string): void {
    const octets = new TextEncoder().encode(`${text}\n`);
    this.writing = this.writing.then(async () => {
      const writer = this.port.writable?.getWriter();
      try {
        await writer?.write(octets);
      } finally {
        writer?.releaseLock();
      }
    }).catch(() => this.gone('broken'));
  }

  async close(): Promise<void> {
    this.closing = true;
    await this.reader?.cancel().catch(() => undefined);
    await this.reading;
    await this.writing;
    await this.port.close().catch(() => undefined);
    this.release();
  }

  /** Framing and parity errors end a stream, and the port goes on with a new one. */
  private async read(): Promise<void> {
    while (this.port.readable && !this.closing) {
      this.reader = this.port.readable.getReader();
      try {
        for (;;) {
          const { value, done } = await this.reader.read();
          if (done) break;
          this.events.octets(value);
        }
      } catch (error) {
        if ((error as DOMException).name === 'NetworkError') break;
      } finally {
        this.reader.releaseLock();
      }
    }
    if (!this.closing) this.gone('unplugged');
  }

  private gone(reason: 'unplugged' | 'broken'): void {
    if (this.closing) return;
    this.closing = true;
    void this.port.close().catch(() => undefined).then(this.release);
    this.events.lost(reason);
  }
}
