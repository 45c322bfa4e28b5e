#pragma once
// What the machine does about each trouble, and what brings it back: the documented part of docs/whole-machine-campaign.md, and what its runs are judged by.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/alarm.hpp"
#include "tests/whole_machine/whole_run.hpp"

namespace taktwerk::whole {

struct Documented {
    Reaction least = Reaction::none;  ///< of a machine that works, to this trouble alone
    Reaction most = Reaction::none;
    std::string_view does, back;
};

[[nodiscard]] const Documented& documented(Trouble trouble) noexcept;
/// The alarms that it names: words in back-quotes.
[[nodiscard]] std::vector<std::string> alarms_named(std::string_view text);
/// What in a run is not as documented; empty: nothing.
[[nodiscard]] std::string judged(const WholeRun& run);

/// Runs by trouble. Reactions: of runs with this trouble alone.
struct Counted {
    long runs = 0;
    std::array<long, 5> reactions{};
    std::array<long, whole_end_names.size()> ends{};
};
using AllCounted = std::map<Trouble, Counted>;
void count(AllCounted& all, const WholeRun& run);

inline constexpr std::string_view runs_heading = "## Runs\n";
[[nodiscard]] std::string documented_page();
[[nodiscard]] std::string counted_page(const AllCounted& all, long runs, long commands);

}  // namespace taktwerk::whole
