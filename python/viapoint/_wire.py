"""Calls to a viapoint-controller: messages, time limits, and refusals as errors.

The messages are those of ``proto/viapoint/controller.proto``, whose description the build puts
beside the extension.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import grpc
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

from . import _core
from ._arguments import file_name
from ._tls import TlsFiles
from .errors import FileError, MotionError, NotInControlError, UnconnectedError, from_problem

DESCRIPTORS = Path(_core.__file__).parent / "controller.binpb"
_PACKAGE = "viapoint.v1"
_PROBLEM = "viapoint-problem-bin"
_CROWDED = "HTTP status 503"
"""How gRPC tells of a controller that has no room for one more connection."""
_FULL = "too many calls wait"
"""How a controller tells of a call that it has not begun."""
_READS = "Get"
"""Calls whose names begin so change nothing, and may be made again whatever became of them."""
_AGAIN = 0.02
"""A call is made again after so long [s]."""
_OPTIONS: list[tuple[str, int]] = [
    ("grpc.enable_http_proxy", 0),
    ("grpc.max_receive_message_length", 1 << 22),
    ("grpc.initial_reconnect_backoff_ms", 100),
    ("grpc.max_reconnect_backoff_ms", 1000),
]
PATIENCE = 10.0
"""So long [s] an answer is waited for."""

# Messages of a description that is read at run time have no types of their own.
Message = Any


def _load_messages() -> dict[str, type[Message]]:
    """Read the messages' description, once for the process."""
    if not DESCRIPTORS.exists():
        raise ImportError("this viapoint was built without VIAPOINT_BUILD_REMOTE")
    files = descriptor_pb2.FileDescriptorSet()
    files.ParseFromString(DESCRIPTORS.read_bytes())
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    (name,) = [file.name for file in files.file]
    types = pool.FindFileByName(name).message_types_by_name
    return {name: message_factory.GetMessageClass(descriptor) for name, descriptor in types.items()}


_MESSAGES = _load_messages()


def message(kind: str, /, **fields: object) -> Message:
    """Make a message of the proto file."""
    return _MESSAGES[kind](**fields)


def error_of(problem: Message) -> MotionError:
    """Make the exception that a message ``Problem`` stands for."""
    optional = ("move", "line", "joint", "time", "share", "value", "limit")
    fields = {name: getattr(problem, name) for name in optional if problem.HasField(name)}
    return from_problem(
        _core.Problem(
            problem.code,
            problem.message,
            ways_out=list(problem.ways_out),
            file=problem.file,
            **fields,
        )
    )


def _credentials(files: TlsFiles) -> grpc.ChannelCredentials:
    def content(path: object) -> bytes:
        name = file_name(path)
        try:
            return Path(name).read_bytes()
        except OSError as error:
            raise FileError(f"The TLS file cannot be read: {error.strerror}.", file=name) from None

    return grpc.ssl_channel_credentials(
        content(files.authority), content(files.key), content(files.certificate)
    )


class Wire:
    """A connection to a controller. Threads: any.

    Parameters
    ----------
    address : str
        Host and port.
    tls : TlsFiles, optional
        Without, nothing is encrypted.
    """

    def __init__(self, address: str, tls: TlsFiles | None) -> None:
        self.address = address
        self._channel = (
            grpc.insecure_channel(address, options=_OPTIONS)
            if tls is None
            else grpc.secure_channel(address, _credentials(tls), options=_OPTIONS)
        )
        self._calls: dict[str, Callable[..., Message]] = {}

    def call(
        self, method: str, request: Message, reply: str, *, patience: float = PATIENCE
    ) -> Message:
        """Ask the controller, and wait for its answer.

        Raises
        ------
        UnconnectedError
            It cannot be reached, or does not answer in time.
        NotInControlError, MotionError
            It refuses.
        """
        if method not in self._calls:
            self._calls[method] = self._channel.unary_unary(
                f"/{_PACKAGE}.Controller/{method}",
                request_serializer=type(request).SerializeToString,
                response_deserializer=_MESSAGES[reply].FromString,
            )
        end = time.monotonic() + patience
        while True:
            try:
                return self._calls[method](request, timeout=patience)
            except grpc.RpcError as error:
                if time.monotonic() > end or not _may_be_made_again(error, method):
                    raise self._translated(error, method) from None
            except ValueError:  # of a channel that another thread has closed meanwhile
                raise closed() from None
            time.sleep(_AGAIN)

    def _translated(self, error: grpc.RpcError, method: str) -> MotionError:
        status: Any = error  # a call that failed is its own status; the type does not say so
        for key, value in status.trailing_metadata() or ():
            if key == _PROBLEM:
                told = error_of(_MESSAGES["Problem"].FromString(value))
                if status.code() == grpc.StatusCode.PERMISSION_DENIED:
                    return NotInControlError(told.message, ways_out=told.ways_out)
                return told
        if _CROWDED in (status.details() or ""):
            return UnconnectedError(
                f"The controller at {self.address} has too many connections.",
                ways_out=["Close those that are not needed, or connect later."],
            )
        return UnconnectedError(
            f"The controller at {self.address} did not answer {method}: "
            f"{status.code().name}, {status.details()}.",
            ways_out=["See that it runs, listens there, and has the same version as this."],
        )

    def close(self) -> None:
        """Hang up."""
        with contextlib.suppress(ValueError):
            self._channel.close()


def _may_be_made_again(error: grpc.RpcError, method: str) -> bool:
    """Tell whether the call was not begun, or only reads and its answer was given up in a crowd."""
    status: Any = error
    if _FULL in (status.details() or ""):
        return True
    return method.startswith(_READS) and status.code() == grpc.StatusCode.CANCELLED


def closed() -> UnconnectedError:
    """Make the error of an arm that is used after its end."""
    return UnconnectedError(
        "The arm is no longer connected.", ways_out=["Connect again: viapoint.connect(...)."]
    )
