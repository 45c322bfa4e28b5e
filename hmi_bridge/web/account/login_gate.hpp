#pragma once
// How often somebody may try to log in. Whoever guesses waits; whom he pretends to be does not: who has logged in from an address before has tries of
// his own there, half of a name's tries are kept for addresses that have not failed, and at this computer itself only the address counts. An IPv6
// address is its network of 64 bits, of which one computer has them all (RFC 4291 section 2.5.1). Constant memory. Not thread-safe; not real-time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::hmi::web {

class LoginGate {
public:
    static constexpr double most_tries = 10;                       ///< at once: of an address, of a name, of a known pair of both
    static constexpr Duration one_more = std::chrono::seconds{6};  ///< then one each: 600 an hour
    static constexpr std::size_t known_pairs = 64;

    /// `seed`: unknown to strangers, so that nobody finds names that share a slot.
    explicit LoginGate(std::uint64_t seed) : seed_(seed) {}

    /// Zero: try. Else how long to wait; nothing was used up.
    Duration ask(std::string_view user, std::string_view address, Instant now);
    void succeeded(std::string_view user, std::string_view address, Instant now);
    /// He has logged in from there before.
    [[nodiscard]] bool knows(std::string_view user, std::string_view address) const;
    void failed(std::string_view user, std::string_view address);

private:
    static constexpr std::size_t slots = 1024;
    struct Bucket {
        double used = 0;
        Instant at{};

        /// Of the `most` tries, after what has come back since.
        double used_at(Instant now);
    };
    struct Pair {
        std::string user, address;
        Bucket tries;
    };
    [[nodiscard]] std::size_t slot(std::string_view text) const;
    Pair* known(std::string_view user, const std::string& network);

    std::uint64_t seed_;
    std::array<Bucket, slots> by_user_{}, by_address_{};
    std::array<bool, slots> has_failed_{};  ///< of addresses
    std::deque<Pair> known_;                ///< the newest last
};

}  // namespace taktwerk::hmi::web
