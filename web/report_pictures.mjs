// SPDX-License-Identifier: Apache-2.0
// Pictures of parts of a lab report: report_pictures.mjs REPORT OUT PART... writes OUT/lab_PART.png for each.
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { openBrowser } from './drive.mjs';

const [report, out, ...parts] = process.argv.slice(2);
const browser = await openBrowser();
try {
  const page = await browser.newPage({ viewport: { width: 1240, height: 900 } });
  await page.goto(pathToFileURL(report).href);
  for (const part of parts) {
    const box = page.locator(`#${part}`);
    await box.scrollIntoViewIfNeeded();
    // Strips say so when they are drawn; plots are from the start.
    await page.waitForFunction((id) => {
      const of = document.getElementById(id);
      return of && (!of.classList.contains('strip') || of.dataset.drawn);
    }, part, { timeout: 120_000 });
    await box.screenshot({ path: join(out, `lab_${part}.png`) });
  }
} finally {
  await browser.close();
}
