// SPDX-License-Identifier: Apache-2.0

/** Gives the browser a file to keep. */
export function download(name: string, content: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function savePicture(canvas: HTMLCanvasElement): void {
  canvas.toBlob((picture) => picture && download('resect.png', picture), 'image/png');
}

const framesPerSecond = 30;

/** Films the canvas until it is stopped. */
export class Film {
  private recorder: MediaRecorder | undefined;

  get isOn(): boolean {
    return this.recorder !== undefined;
  }

  start(canvas: HTMLCanvasElement): void {
    const type = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/mp4'].find((one) => MediaRecorder.isTypeSupported(one));
    if (!type) throw new Error('This browser films nothing; take a picture, or use another browser.');
    const parts: Blob[] = [];
    const recorder = new MediaRecorder(canvas.captureStream(framesPerSecond), { mimeType: type, videoBitsPerSecond: 12_000_000 });
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => download(type.includes('mp4') ? 'resect.mp4' : 'resect.webm', new Blob(parts, { type }));
    recorder.start();
    this.recorder = recorder;
  }

  stop(): void {
    this.recorder?.stop();
    this.recorder = undefined;
  }
}
