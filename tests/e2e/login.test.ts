/** A server that has tokens: the page asks for one, shows what a role may, and stops in any case. */
import { expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

it("asks for a token, offers what its role may, and stops without any", async () => {
  const server = await CovrServer.start();
  const { page } = await Dashboard.open(server.url);
  const observer = await server.token("visitors' screen", "observer");
  const master = await server.token("front desk", "game_master");
  await until("the server asks", 10_000, async () => (await fetch(`${server.url}/api/v1/state`)).status === 401);
  await page.reload();
  await page.getByTestId("sign-in").waitFor();

  await page.keyboard.press("Escape");
  await page.getByText("stopped: acknowledged").waitFor();

  const signIn = async (token: string): Promise<void> => {
    await page.getByTestId("token").fill(token);
    await page.getByTestId("sign-in-confirm").click();
  };
  await signIn(`${observer.slice(0, -4)}0000`);
  await page.getByTestId("sign-in-trouble").waitFor();
  await signIn(observer);
  await page.getByTestId("why-not-reset").getByText("not for your role").waitFor();
  expect(await page.getByTestId("reset").isDisabled()).toBe(true);
  expect(await page.getByTestId("mode").getAttribute("data-mode")).toBe("latched_stop");

  await page.getByTestId("sign-out").click();
  await signIn(master);
  await until("the reset is offered", 10_000, () => page.getByTestId("reset").isEnabled());
  await page.getByTestId("reset").click();
  await page.getByTestId("reset-reason").fill("nobody was there");
  await page.getByTestId("reset-confirm").click();
  await until("it is disarmed", 10_000, async () => (await page.getByTestId("mode").getAttribute("data-mode")) === "disarmed");
  await page.getByTestId("events").getByText("front desk (game master)").first().waitFor();
});
