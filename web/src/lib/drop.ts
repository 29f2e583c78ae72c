/** A file dragged onto the page, wherever it is let go. */
import { createSignal, onCleanup, onMount, type Accessor } from "solid-js";

/** Whether a file hangs over the page; what is let go is taken. */
export function createFileDrop(take: (file: File) => void): Accessor<boolean> {
  const [dragging, setDragging] = createSignal(false);
  onMount(() => {
    const over = (event: DragEvent): void => {
      if (event.dataTransfer?.types.includes("Files") !== true) return;
      event.preventDefault();
      setDragging(true);
    };
    const out = (event: DragEvent): void => {
      if (event.relatedTarget === null) setDragging(false);
    };
    const drop = (event: DragEvent): void => {
      setDragging(false);
      const file = event.dataTransfer?.files[0];
      if (file === undefined) return;
      event.preventDefault();
      take(file);
    };
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", out);
    window.addEventListener("drop", drop);
    onCleanup(() => {
      window.removeEventListener("dragover", over);
      window.removeEventListener("dragleave", out);
      window.removeEventListener("drop", drop);
    });
  });
  return dragging;
}
