#pragma once
// Who says what, how often, and what was lost. Logic alone: messages in, rows out. Not real-time.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::apps {

/// "TAKTWERK_DEMO_" of "TAKTWERK_DEMO_AXIS_STATE"; empty: the channel is of no machine of ours.
[[nodiscard]] std::string machine_prefix(std::string_view channel);

class ChannelBook {
public:
    static constexpr std::size_t most_channels = 4096;  ///< anybody may make up channels

    /// `catalog` outlives it.
    explicit ChannelBook(const hmi::TypeCatalog& catalog) : catalog_(catalog) {}

    /// In the order in which they came. `utime`: when, us since 1970.
    void note(std::string_view channel, std::span<const std::byte> message, std::int64_t utime);

    struct Row {
        std::string channel;
        std::string type;  ///< its name; "0x1234..." where the fingerprint is unknown; "none" below 8 bytes
        std::uint64_t messages = 0, bytes = 0;
        std::size_t last_size = 0;
        std::int64_t first_utime = 0, last_utime = 0;
        double rate = 0;  ///< messages a second, of the last one to two seconds
    };
    /// By name. `utime`: now.
    [[nodiscard]] std::vector<Row> rows(std::int64_t utime) const;

    /// All state messages of a machine are counted in one `seq`: what is missing in it was lost on the way. It says nothing where only some channels are heard.
    struct Machine {
        std::string prefix;
        std::uint64_t messages = 0, lost = 0, restarts = 0;
    };
    [[nodiscard]] std::vector<Machine> machines() const;
    [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }
    [[nodiscard]] std::uint64_t lost() const;
    [[nodiscard]] std::uint64_t unlisted() const noexcept { return unlisted_; }  ///< messages on channels beyond most_channels

private:
    struct Channel {
        Row row;
        std::int64_t window_utime = 0;
        std::uint64_t window_messages = 0;
        double window_rate = -1;  // of the window before; -1: none yet
    };
    struct Sequence {
        std::uint64_t messages = 0, lost = 0, restarts = 0;
        std::int64_t last = 0;
    };
    const hmi::TypeCatalog& catalog_;
    std::map<std::string, Channel, std::less<>> channels_;
    std::map<std::string, Sequence, std::less<>> sequences_;
    std::uint64_t messages_ = 0, unlisted_ = 0;
};

}  // namespace taktwerk::apps
