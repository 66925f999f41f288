// How core reports failures that a user can cause: a value or an Error, never an exception across a function.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace tessera {

// What kind of failure it was; tessera-cli's exit codes follow it one to one.
enum class ErrorCode { Usage, CannotRead, DamagedDocument, CannotWrite, Internal, Stopped };

// `message` is one sentence for a person: what failed, on which file, and what to do.
struct Error {
    ErrorCode code = ErrorCode::Internal;
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> failure(ErrorCode code, std::string message) {
    return tl::unexpected<Error>(Error{code, std::move(message)});
}

// The one Error of a job that was asked to stop.
inline tl::unexpected<Error> stopped() {
    return failure(ErrorCode::Stopped, "stopped on request");
}

}  // namespace tessera
