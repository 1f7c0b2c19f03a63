// SPDX-License-Identifier: Apache-2.0
import { decodeBinary, encodeUpload, type EngineText, type FileMessage, type Frame, type Request } from './protocol.ts';

export interface Listener {
  opened(): void;
  closed(): void;
  text(text: EngineText): void;
  frame(frame: Frame): void;
  file(file: FileMessage): void;
  failed(message: string): void;
}

const retryAfter = 1000;

/** The WebSocket to the engine; it comes back by itself when the engine does. */
export class Connection {
  private socket: WebSocket | undefined;
  private lastId = 0;
  /** Messages whose effect no frame has shown yet. */
  private readonly sentAt = new Map<number, number>();
  private readonly url: string;
  private readonly listener: Listener;

  constructor(url: string, listener: Listener) {
    this.url = url;
    this.listener = listener;
    this.open();
  }

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Milliseconds from sending each message up to `last` until now; each is answered once. */
  takeLatencies(last: number): number[] {
    const now = performance.now(), taken: number[] = [];
    for (const [id, at] of this.sentAt) {
      if (id > last) break;
      taken.push(now - at);
      this.sentAt.delete(id);
    }
    return taken;
  }

  /** Answers the id; 0 where the engine is not there. */
  send(request: Request): number {
    if (!this.isOpen) return 0;
    this.socket?.send(JSON.stringify({ id: ++this.lastId, ...request }));
    this.sentAt.set(this.lastId, performance.now());
    return this.lastId;
  }

  upload(name: string, content: Uint8Array): void {
    if (this.isOpen) this.socket?.send(encodeUpload(name, content));
  }

  private open(): void {
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.listener.opened();
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.hear(event.data);
    socket.onclose = (event) => {
      if (event.reason) this.listener.failed(event.reason);
      this.listener.closed();
      setTimeout(() => this.open(), retryAfter);
    };
    this.socket = socket;
  }

  private hear(data: string | ArrayBuffer): void {
    try {
      if (typeof data === 'string') {
        this.listener.text(JSON.parse(data) as EngineText);
        return;
      }
      const message = decodeBinary(data);
      if ('file' in message) {
        this.listener.file(message.file);
      } else {
        this.listener.frame(message.frame);
        this.socket?.send(JSON.stringify({ seen: message.frame.frame }));
      }
    } catch (error) {
      this.listener.failed((error as Error).message);
    }
  }
}
