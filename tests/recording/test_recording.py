"""Recordings as another library reads them: `tests/recording/check`."""

import collections
import json
import os
import pathlib

import jsonschema_rs
import pytest
from mcap.reader import make_reader

FOLDER = pathlib.Path(os.environ["RECORDINGS"])
FOXGLOVE = json.loads((FOLDER / "schemas.json").read_text())
TOPICS = {
    "/plan": "foxglove.SceneUpdate",
    "/network": "foxglove.SceneUpdate",
    "/log": "foxglove.Log",
    "/numbers": "pleach.Numbers",
}


class Recording:
    def __init__(self, name):
        lines = [json.loads(line) for line in (FOLDER / f"{name}.jsonl").open()]
        self.steps = [line for line in lines if line["type"] == "step"]
        self.events = [line for line in lines if line["type"] == "event"]
        self.robots = len(lines[0]["scenario"]["robot"])
        self.messages = collections.defaultdict(list)
        with (FOLDER / f"{name}.mcap").open("rb") as file:
            reader = make_reader(file, validate_crcs=True)
            self.summary = reader.get_summary()
            for schema, channel, message in reader.iter_messages():
                assert (schema.name, schema.encoding) == (TOPICS[channel.topic], "jsonschema")
                assert channel.message_encoding == "json"
                self.messages[channel.topic].append((message.log_time, json.loads(message.data)))
        self.schemas = {schema.name: json.loads(schema.data) for schema in self.summary.schemas.values()}


@pytest.fixture(scope="module", params=["too-few", "study-1"])
def recording(request):
    return Recording(request.param)


def test_every_topic_is_there_and_counted(recording):
    assert set(recording.messages) == set(TOPICS)
    assert len(recording.messages["/plan"]) == 1
    assert len(recording.messages["/network"]) == len(recording.steps)
    assert len(recording.messages["/log"]) == len(recording.events) + 1
    counts = recording.summary.statistics.channel_message_counts
    names = {channel.topic: counts[number] for number, channel in recording.summary.channels.items()}
    assert names == {topic: len(messages) for topic, messages in recording.messages.items()}


def test_messages_are_what_their_schemas_say(recording):
    for topic, messages in recording.messages.items():
        name = TOPICS[topic]
        schemas = [recording.schemas[name]] + [FOXGLOVE[known] for known in FOXGLOVE if known == name]
        validators = [jsonschema_rs.validator_for(schema) for schema in schemas]
        for _, message in messages:
            for validator in validators:
                validator.validate(message)


def test_schemas_know_no_field_that_foxglove_does_not(recording):
    def fields(schema, path=""):
        for name, inner in schema.get("properties", {}).items():
            yield f"{path}/{name}"
            yield from fields(inner, f"{path}/{name}")
        if "items" in schema:
            yield from fields(schema["items"], path)

    for name, schema in FOXGLOVE.items():
        assert set(fields(recording.schemas[name])) <= set(fields(schema))


def test_messages_say_what_the_trace_says(recording):
    for step, (time, scene), (_, numbers) in zip(
        recording.steps, recording.messages["/network"], recording.messages["/numbers"], strict=True
    ):
        assert abs(time * 1e-9 - step["t"]) < 1e-6
        (network,) = scene["entities"]
        stamp = network["timestamp"]
        assert stamp["sec"] * 10**9 + stamp["nsec"] == time
        places = [disc["pose"]["position"] for disc in network["cylinders"]]
        assert [[place["x"], place["y"]] for place in places] == step["position"]
        assert [text["text"] for text in network["texts"]] == [str(i) for i in range(recording.robots)]
        assert numbers["k"] == step["k"] and numbers["residual"] == step["residual"]
        assert len(network["lines"]) == len(step["route"]) + 1, "the links, and the tree"
