#pragma once
// The host's side of one line: one transaction at a time, stepped. Service side, one thread, not real-time; deterministic on a virtual line.
//
//   idle --ask()--> waiting --answer--> idle
//                   waiting --nothing, or damaged--> resting --> waiting        `tries` times in all
//
// An answer names no address: one that comes after its question was given up, or asked again, would pass for that of the next one like it. Such a
// question waits until none can come any more.
// Between frames the line rests for 3.5 characters (manual 9.3). After a save (41h) that station is not asked for 5 s (manual 9.6.6);
// others on the line are.

#include <array>
#include <cstdint>
#include <optional>

#include "core/time.hpp"
#include "modbus/line/serial_line.hpp"
#include "modbus/wire/frame.hpp"

namespace taktwerk::modbus {

struct ClientConfig {
    /// From the last byte of a request to the first of its answer; the manual states none. Longer: the drive is taken as silent.
    Duration answer_timeout = std::chrono::milliseconds{50};
    std::uint8_t tries = 2;  ///< in all, for what may be asked twice
};

/// How a transaction ended.
enum class Outcome : std::uint8_t {
    answered,   ///< as asked
    exception,  ///< refused by the drive; Answer::response.exception says why
    silent,     ///< nothing came, in no try
    damaged,    ///< something came, in the last try, but no answer
    no_port,    ///< the port is not there
};
[[nodiscard]] std::string_view name(Outcome outcome) noexcept;

struct Answer {
    Outcome outcome = Outcome::silent;
    Request request;
    Response response;
    Instant sampled{};  ///< about when the drive took the values: when its answer began
    Duration took{};
};

struct ClientStatistics {
    std::uint64_t asked = 0, answered = 0, exceptions = 0, retries = 0, timeouts = 0, damaged = 0;
    Duration longest{};  ///< of an answered transaction
};

/// Why a request is not even sent.
enum class Refusal : std::uint8_t {
    none,
    busy,            ///< one is under way, or the line must rest
    too_many_words,  ///< more than 8 read, or 10 written
    no_words,
    saving,  ///< the drive saves its parameters
};
[[nodiscard]] std::string_view name(Refusal refusal) noexcept;

class Client {
public:
    /// `line` outlives the client.
    explicit Client(SerialLine& line, const ClientConfig& config = {}) noexcept : line_(line), config_(config) {}

    /// A question; its answer comes from a later step().
    [[nodiscard]] Refusal ask(const Request& request, Instant now);
    [[nodiscard]] Refusal may_ask(const Request& request, Instant now) const noexcept;
    [[nodiscard]] bool idle(Instant now) const noexcept { return state_ == State::idle && now >= quiet_until_; }
    /// The answer, once, when it is there. Call often, also while nothing is asked: the line is looked at each time, which throws away what
    /// nobody asked for, and is what a computed line (virtual_line.hpp) lets its drives live on by.
    std::optional<Answer> step(Instant now);
    /// Until then this station saves and must not be asked.
    [[nodiscard]] Instant saving_until(std::uint8_t station) const noexcept { return saving_[station]; }

    [[nodiscard]] const ClientStatistics& statistics() const noexcept { return statistics_; }
    [[nodiscard]] const LineSettings& settings() const noexcept { return line_.settings(); }
    /// Worst time of a transaction with so many bytes each way, without a retry.
    [[nodiscard]] Duration worst_time(std::size_t request_bytes, std::size_t response_bytes) const noexcept;

private:
    enum class State : std::uint8_t { idle, resting, waiting };
    void send(Instant now);
    [[nodiscard]] bool may_get_the_answer_to_another(const Request& request, Instant now) const noexcept;
    std::optional<Answer> again_or_end(Outcome outcome, Instant now);
    Answer end(Outcome outcome, Instant now);

    SerialLine& line_;
    ClientConfig config_;
    State state_ = State::idle;
    Request request_;
    Frame heard_;
    Instant asked_at_{}, sent_at_{}, last_byte_{}, quiet_until_{};
    std::uint8_t tries_left_ = 0;
    bool unanswered_ = false;  // a try of this transaction
    Request owed_;             // its answer may still come ...
    Instant owed_until_{};     // ... until then
    bool port_there_ = false;
    std::array<Instant, 256> saving_{};
    ClientStatistics statistics_;
};

}  // namespace taktwerk::modbus
