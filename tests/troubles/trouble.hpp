#pragma once
// One trouble of a bus: how it is staged, and what has to be said about it. The table is all_troubles(); the test compares every row,
// and docs/troubles.md is written from it.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"

namespace taktwerk::troubles {

class Bench;

/// Where it is said.
enum class Teller : std::uint8_t {
    check,  ///< `taktwerk check`: the file alone shows it
    scan,   ///< `taktwerk bus scan`
    why,    ///< `taktwerk bus why`, and `run` while the bus comes up
    port,   ///< every command that opens the network port
    alarm,  ///< the alarms of a machine that runs
};

/// Somebody beside the slaves and their cables who may be the cause. Named although it was not him, he would be accused.
enum class Culprit : std::uint8_t { bus, this_computer, other_master };

/// What was said, in the words of the product.
struct Said {
    std::string id, place, cause, remedy;
    Duration after{};  ///< since the bring-up began, or since the trouble struck
    bool operator==(const Said&) const = default;
};

struct Trouble {
    std::string_view name, staged;
    Teller teller = Teller::why;
    std::string_view configured = "sts";       ///< devices of the file, by the letters of bench.hpp
    std::string_view there = {};               ///< on the cable; empty: the same
    void (*before)(Bench&) = nullptr;          ///< before anybody looks
    void (*strikes)(Bench&) = nullptr;         ///< in OP, for alarms
    Said (*opens)() = nullptr;                 ///< a network port, in a network of the test's own
    std::string_view id = {};                  ///< of the error or of the alarm
    std::string_view place = {};               ///< has to stand in its place
    std::string_view cause = {}, remedy = {};  ///< have to stand in the text
    std::string_view named = {};               ///< the slaves that may be named, by their letters; who else is named is accused
    Culprit culprit = Culprit::bus;
    Duration patience{};  ///< how long a standard gives the slave before anything can be said; two seconds more are allowed
};

[[nodiscard]] std::vector<Trouble> all_troubles();

/// One chapter of the table, and of the page.
struct Chapter {
    std::string_view title, introduction;
    std::vector<Trouble> troubles;
};
[[nodiscard]] std::vector<Chapter> chapters();

[[nodiscard]] Chapter network_port();
[[nodiscard]] Chapter wrong_slaves();
[[nodiscard]] Chapter wrong_cables();
[[nodiscard]] Chapter wrong_settings();
[[nodiscard]] Chapter refused_states();
[[nodiscard]] Chapter refused_mailboxes();
[[nodiscard]] Chapter lost_on_the_way();
[[nodiscard]] Chapter lost_in_operation();
[[nodiscard]] Chapter unwell_in_operation();

/// False: it needs a network of its own, and this system gives none.
[[nodiscard]] bool can_be_staged(const Trouble& trouble);
/// Stages it from nothing. Empty: nothing was said.
[[nodiscard]] std::vector<Said> staged(const Trouble& trouble);
/// Who was named although the row does not allow it: letters of slaves, "this computer", "another master".
[[nodiscard]] std::vector<std::string> accused(const Trouble& trouble, const Said& said);

}  // namespace taktwerk::troubles
