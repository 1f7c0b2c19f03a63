// SPDX-License-Identifier: Apache-2.0

/** For a browser without a screen, as root, that draws on the processor. */
export const chromiumFlags = [
  '--no-sandbox', '--use-angle=gl-egl', '--ignore-gpu-blocklist', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
];
