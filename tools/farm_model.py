#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""farm_model.py [--frames N] [--machines N] [--regions N] ...: simulates a shot on a render farm, from measured bytes and
seconds. Prints when the shot is finished, what machines wait for, and the bytes that cross the file server.
docs/lab/FARM.md states where the defaults were measured."""
import argparse
import heapq
import random

MB, GB = 1e6, 1e9


class Server:
    """A file server, or the queue: serves one request after the other at a fixed rate."""

    def __init__(self, rate):
        self.rate, self.free, self.served, self.waited = rate, 0.0, 0.0, 0.0

    def finish(self, now, amount):
        """When a request that arrives now is served."""
        begin = max(now, self.free)
        self.free = begin + amount / self.rate
        self.served += amount
        self.waited += begin - now
        return self.free


class Shot:
    """The tasks that are left, and what has happened."""

    def __init__(self, options):
        self.options, self.random = options, random.Random(options.seed)
        self.files, self.queue = Server(options.bandwidth), Server(options.starts_per_s)
        cpu_s = options.frame_cpu_s / options.regions * (1 + (options.region_cost if options.regions > 1 else 0))
        # A task: its frame, the seconds that are left, and whether it measures the boxes of the frame for the regions.
        self.waiting, self.regions, self.growing = [], {}, 0
        seconds = [cpu_s * self.random.lognormvariate(-0.5 * options.spread ** 2, options.spread) / options.threads
                   for _ in range(options.frames * options.regions)]
        for frame in reversed(range(options.frames)):
            regions = [(frame, seconds.pop(), False) for _ in range(options.regions)]
            if options.regions > 1 and options.grow_cpu_s > 0:
                self.regions[frame] = regions
                self.growing += 1
                self.waiting.append((frame, options.grow_cpu_s / options.threads, True))
            else:
                self.waiting += regions
        self.pieces = [options.regions] * options.frames
        self.killed, self.busy_s, self.merge_s, self.end = 0, 0.0, 0.0, 0.0

    def machine(self, now):
        """What one machine does: takes tasks until none is left. Yields times at which it goes on, in which order requests
        reach the servers."""
        options, warm = self.options, False
        while self.waiting or self.growing:
            if not self.waiting:  # regions follow when boxes are measured
                now = yield now + 1
                continue
            frame, left, grows = self.waiting.pop()
            now = yield self.queue.finish(now, 1)
            now = yield self.files.finish(now, options.scene_bytes + (0 if warm else options.cache_bytes))
            warm = True
            now = yield now + options.startup_cpu_s
            while left > 0:
                step = min(left, options.every)
                if self.random.random() < step / (options.hours_between_failures * 3600):
                    break
                now = yield now + step
                self.busy_s += step
                left -= step
                if left > 0 and not grows:
                    now = yield self.files.finish(now, options.film_bytes / options.regions)
            if left > 0:  # killed: the task continues from its last checkpoint, on the machine that is free next
                self.killed += 1
                self.waiting.append((frame, options.grow_cpu_s / options.threads if grows else left, grows))
                warm = False
                now = yield now + options.repair_s
                continue
            if grows:
                now = yield self.files.finish(now, options.box_bytes)
                self.waiting += self.regions.pop(frame)  # they come before further frames
                self.growing -= 1
                continue
            now = yield self.files.finish(now, options.picture_bytes / options.regions)
            self.pieces[frame] -= 1
            if self.pieces[frame] == 0 and options.regions > 1:
                now = yield self.queue.finish(now, 1)
                now = yield self.files.finish(now, options.picture_bytes)
                now = yield now + options.merge_s
                now = yield self.files.finish(now, options.picture_bytes)
                self.merge_s += options.merge_s
            self.end = max(self.end, now)


def simulate(options):
    shot = Shot(options)
    machines = [shot.machine(0.0) for _ in range(options.machines)]
    events = [(next(machine, None), number) for number, machine in enumerate(machines)]
    events = [event for event in events if event[0] is not None]
    heapq.heapify(events)
    while events:
        now, number = heapq.heappop(events)
        try:
            heapq.heappush(events, (machines[number].send(now), number))
        except StopIteration:
            pass
    return {"hours": shot.end / 3600, "busy": shot.busy_s / (shot.end * options.machines), "bytes": shot.files.served,
            "killed": shot.killed, "file_wait_s": shot.files.waited / options.machines,
            "queue_wait_s": shot.queue.waited / options.machines, "server": shot.files.served / shot.files.rate / shot.end,
            "merge_hours": shot.merge_s / 3600}


def parser():
    numbers = {"frames": (10000, "frames of the shot"), "machines": (1000, "machines"), "regions": (1, "regions of a frame"),
               "threads": (16, "threads of a machine"), "frame-cpu-s": (3800, "CPU seconds of a frame, without start-up"),
               "region-cost": (0.1, "additional CPU time of a frame that is divided, as a fraction"),
               "grow-cpu-s": (33, "CPU seconds of measuring the boxes of a frame, in a task ahead of its regions; 0: no such tasks"),
               "box-bytes": (8.3 * MB, "boxes of a frame"),
               "startup-cpu-s": (10, "seconds from the start of a task to its first ray, with warm caches"),
               "cache-bytes": (150 * MB, "caches that a machine reads once"), "scene-bytes": (20 * MB, "read by every task"),
               "film-bytes": (190 * MB, "checkpoint of a frame"), "picture-bytes": (65 * MB, "EXR file of a frame"),
               "merge-s": (6, "seconds of a merge on its machine"), "every": (60, "seconds between checkpoints"),
               "bandwidth": (1.25 * GB, "bytes per second of the file server"),
               "starts-per-s": (50, "tasks that the queue starts per second"), "spread": (0.3, "of the times of tasks"),
               "hours-between-failures": (500, "of a machine"), "repair-s": (600, "until a failed machine is back"),
               "seed": (1, "of random numbers")}
    result = argparse.ArgumentParser(description=__doc__)
    for name, (value, text) in numbers.items():
        result.add_argument(f"--{name}", type=type(value), default=value, help=f"{text} (default: {value:g})")
    return result


def main():
    result = simulate(parser().parse_args())
    print(f"{result['hours']:.2f} h; machines render {100 * result['busy']:.0f} % of the time; "
          f"{result['bytes'] / 1e12:.2f} TB, file server {100 * result['server']:.0f} % busy; "
          f"a machine waits {result['file_wait_s']:.0f} s for files and {result['queue_wait_s']:.0f} s for the queue; "
          f"{result['killed']} tasks killed; {result['merge_hours']:.1f} machine hours of merges")


if __name__ == "__main__":
    main()
