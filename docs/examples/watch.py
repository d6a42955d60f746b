"""Watches a Lvis daemon: has it filter the paths, and counts them by class.

    pip install grpcio grpcio-tools numpy && mkdir stubs
    python -m grpc_tools.protoc -I proto --python_out=stubs --grpc_python_out=stubs proto/lvis/v1/*.proto
    PYTHONPATH=stubs python docs/examples/watch.py 127.0.0.1:50061 --filter 'edges >= 3'
"""
import argparse, collections, threading
import grpc
import numpy as np
from lvis.v1 import tracer_pb2 as wire
from lvis.v1.tracer_pb2_grpc import TracerStub

LETTERS = {0: "L", 3: "D", 4: "S", 6: "E"}


def paths(batch):
    """The steps that each path stands for, and its class from the light to the lens."""
    chain, weight = np.frombuffer(batch.chain, "<u4"), np.frombuffer(batch.weight, "<f4")
    columns = batch.kept_light, batch.kept_eye, batch.inserted, batch.kind
    light, eye, new, kind = (np.frombuffer(column, "u1").astype(int) for column in columns)
    first, last = np.cumsum(new) - new, {}
    for i in range(batch.record_count):
        old = last.get(chain[i], [])
        fresh = list(range(first[i], first[i] + new[i]))
        last[chain[i]] = old[: light[i]] + fresh + old[len(old) - eye[i] :]
        yield weight[i], "".join(LETTERS[k] for k in kind[last[chain[i]]])


def say(text, done):
    """Says hello, and keeps the session open until all is done."""
    version = wire.ProtocolVersion(major=1, minor=1)
    wanted = wire.SetFilter(revision=1, text=text)
    hello = wire.Hello(version=version, viewer_name="watch.py", filter=wanted)
    yield wire.ViewerMessage(hello=hello)
    done.wait()


arguments = argparse.ArgumentParser(description="Counts the paths of a Lvis daemon by class.")
arguments.add_argument("address", help="HOST:PORT")
arguments.add_argument("--filter", default="", help="see docs/FILTERS.md")
arguments.add_argument("--paths", type=int, default=2000, help="how many to count")
options, done = arguments.parse_args(), threading.Event()
steps, count, seen, matched_steps, seen_steps = collections.Counter(), 0, 0, 0.0, 0.0
tracer = TracerStub(grpc.insecure_channel(options.address))
for message in tracer.Watch(say(options.filter, done)):
    batch = message.path_batch  # Without records where the message is something else.
    count, seen = count + batch.matched, seen + batch.seen
    matched_steps, seen_steps = matched_steps + batch.matched_steps, seen_steps + batch.seen_steps
    for weight, letters in paths(batch):
        steps[letters] += weight
    if count >= options.paths:
        break
done.set()
share = 100 * matched_steps / seen_steps
print(f"{count} of {seen} paths match, {share:.2f} % of the image's energy")
for letters, weight in steps.most_common(8):
    print(f"{100 * weight / steps.total():6.2f} %  {letters}")
