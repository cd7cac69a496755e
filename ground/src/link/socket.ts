import { OpenError, type Link, type LinkEvents } from './link';

const OPEN_PATIENCE = 3000;

export function openSocket(url: string, events: LinkEvents): Promise<Link> {
  return new Promise((resolve, reject) => {
    let socket: WebSocket;
    try {
      socket = new WebSocket(url);
    } catch (error) {
      reject(new OpenError('noServer', (error as Error).message));
      return;
    }
    const failed = (): void => {
      socket.close();
      reject(new OpenError('noServer', url));
    };
    const timer = setTimeout(failed, OPEN_PATIENCE);
    socket.binaryType = 'arraybuffer';
    socket.onerror = failed;
    socket.onopen = () => {
      clearTimeout(timer);
      socket.onerror = null;
      resolve(new SocketLink(socket, url, events));
    };
  });
}

class SocketLink implements Link {
  readonly kind = 'socket';
  private closing = false;

  constructor(
    private readonly socket: WebSocket,
    readonly label: string,
    events: LinkEvents,
  ) {
    socket.onmessage = ({ data }) => events.octets(typeof data === 'string' ? new TextEncoder().encode(data) : new Uint8Array(data as ArrayBuffer));
    socket.onclose = () => {
      if (!this.closing) events.lost('serverGone');
    };
  }

  now(): number {
    return performance.timeOrigin + performance.now();
  }

  send(text: string): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(new TextEncoder().encode(`${text}\n`));
  }

  async close(): Promise<void> {
    this.closing = true;
    this.socket.close();
  }
}
