import { createHash } from 'node:crypto';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import type { Duplex } from 'node:stream';

/** A vehicle that says what a test makes it say: the least of a WebSocket server. */
export interface Scripted {
  url: string;
  heard: string[]; // lines of the page
  say(line: string): void;
  send(octets: Buffer): void;
  end(): void;
}

/** Client frames of a browser: masked, whole, and shorter than 126 octets. */
function textOf(frames: Buffer): string {
  let text = '';
  for (let at = 0; at + 6 <= frames.length;) {
    const size = frames[at + 1]! & 127;
    const mask = frames.subarray(at + 2, at + 6);
    if ((frames[at]! & 15) <= 2) text += frames.subarray(at + 6, at + 6 + size).map((octet, i) => octet ^ mask[i % 4]!).toString();
    at += 6 + size;
  }
  return text;
}

export async function scripted(answer: (line: string, say: (line: string) => void) => void): Promise<Scripted> {
  const server: Server = createServer();
  const sockets = new Set<Duplex>();
  const heard: string[] = [];
  const send = (octets: Buffer): void => {
    const head = octets.length < 126 ? [0x82, octets.length] : [0x82, 126, octets.length >> 8, octets.length & 255];
    for (const socket of sockets) socket.write(Buffer.concat([Buffer.from(head), octets]));
  };
  const say = (line: string): void => send(Buffer.from(`${line}\r\n`));
  server.on('upgrade', (request, socket) => {
    const accept = createHash('sha1').update(`${request.headers['sec-websocket-key']}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64');
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    sockets.add(socket);
    socket.on('data', (octets: Buffer) => {
      for (const line of textOf(octets).split('\n').filter((part) => part !== '')) {
        heard.push(line);
        answer(line, say);
      }
    });
    socket.on('close', () => sockets.delete(socket));
    socket.on('error', () => sockets.delete(socket));
  });
  await new Promise<void>((done) => server.listen(0, '127.0.0.1', done));
  return {
    url: `ws://localhost:${(server.address() as AddressInfo).port}`, heard, say, send,
    end: () => {
      server.closeAllConnections();
      for (const socket of sockets) socket.destroy();
      server.close();
    },
  };
}
