#pragma once
// One run of the campaign over a whole machine: a seed draws a machine, a moment and troubles of any source; what has to hold held, and it ends in one of the
// documented ways.

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/alarm.hpp"
#include "core/time.hpp"
#include "tests/whole_machine/trouble.hpp"

namespace taktwerk::whole {

/// What the machine was at when it struck.
enum class Moment : std::uint8_t { bringing_up, by_hand, running, recovering, ending };
inline constexpr std::array<std::string_view, 5> moment_names{"bringing up", "by hand", "running", "recovering", "ending"};

enum class WholeEnd : std::uint8_t {
    none,
    came_back,      ///< every slave in OP, every axis powered, moved and stood; no alarm left
    failed_first,   ///< the bring-up ended with an error that says what to do; the next one came up, and from there as above
    ended_in_order  ///< stopped and switched off although it was told to end at that moment
};
inline constexpr std::array<std::string_view, 4> whole_end_names{"no end", "came back", "failed, then came back", "ended in order"};

struct WholeRun {
    std::uint32_t seed = 0;
    std::string machine;
    Moment moment = Moment::running;
    std::vector<Trouble> troubles;
    Duration length{}, delay{};                 ///< of the first of them; of answers: the longest. 0: it has none
    Duration cycle{};                           ///< of the machine
    bool frames_supervised = false;             ///< one of its drives falls when a few frames in a row do not come
    Reaction reaction = Reaction::none;         ///< the strongest of the alarms that were raised from the first trouble on
    std::set<std::string, std::less<>> alarms;  ///< by their names, of the whole run
    WholeEnd end = WholeEnd::none;
    std::vector<std::string> problems;
    std::string story;  ///< what was done and what came of it
    long commands = 0;
};

/// What a run is to have; what is left out is drawn.
struct Wanted {
    std::string_view machine;  ///< one of machine_names
    std::string_view trouble;  ///< the only one
    std::optional<Moment> moment{};
};
/// A run is the same each time.
[[nodiscard]] WholeRun run_whole(std::uint32_t seed, const Wanted& wanted = {});

}  // namespace taktwerk::whole
