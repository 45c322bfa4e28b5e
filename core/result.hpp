#pragma once
// What a function returns that can fail outside the cycle: a value, or an Error that a technician understands.

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace taktwerk {

/// One thing that went wrong. `code` is stable (documented, scriptable); the sentences may improve.
struct Error {
    std::string code;     ///< stable, lower-case with dots: "config.unknown_key", "bus.wrong_identity"
    std::string subject;  ///< what it concerns: "demo.yaml:12:5", "slave 3 'y_drive'", "axis x", "1C12h:01"; may be empty
    std::string what;     ///< what happened and why, one sentence without a final full stop
    std::string remedy;   ///< what to do, one sentence; may be empty

    /// "subject: what. remedy" on one line.
    [[nodiscard]] std::string text() const;
};

template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT(google-explicit-constructor)
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] bool ok() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return ok(); }

    /// Only when ok().
    [[nodiscard]] T& value() & { return std::get<0>(state_); }
    [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
    [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// Only when not ok().
    [[nodiscard]] const Error& error() const& { return std::get<1>(state_); }
    [[nodiscard]] Error&& error() && { return std::get<1>(std::move(state_)); }

private:
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] bool ok() const noexcept { return !error_.has_value(); }
    explicit operator bool() const noexcept { return ok(); }
    [[nodiscard]] const Error& error() const& { return *error_; }
    [[nodiscard]] Error&& error() && { return std::move(*error_); }

private:
    std::optional<Error> error_;
};

}  // namespace taktwerk
