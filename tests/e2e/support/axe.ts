/** What axe-core says of a page. */
import axe from "axe-core";
import type { Result } from "axe-core";
import type { Dashboard } from "./dashboard";

/** What axe-core finds of serious or critical grade, in words. */
export async function findings(dashboard: Dashboard): Promise<string[]> {
  // What fades in is not yet what it will be.
  await dashboard.page.evaluate(() => Promise.all(document.getAnimations().filter((a) => a.effect?.getComputedTiming().iterations !== Infinity).map((a) => a.finished)));
  // While axe works the browser has no time for snapshots: the values fade, being by then nothing to go by.
  await dashboard.page.addStyleTag({ content: ".stale .fades { opacity: 1 !important; filter: none !important; }" });
  await dashboard.page.evaluate(axe.source);
  const violations = await dashboard.page.evaluate(async () => {
    const run = (window as unknown as { axe: typeof axe }).axe.run;
    return (await run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] })).violations as Result[];
  });
  return violations
    .filter((finding) => finding.impact === "serious" || finding.impact === "critical")
    .flatMap((finding) => finding.nodes.map((node) => `${finding.id}: ${node.target.join(" ")}: ${node.failureSummary ?? ""}`));
}
