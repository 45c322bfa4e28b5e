// Every way in which writing firmware can be interrupted, on a slave with two banks and on one with a single bank: what is said, what is left,
// and that the way back leads back. The table of docs/foe.md is what comes out here; TAKTWERK_REGENERATE=1 writes it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/bytes.hpp"
#include "ecat/wire/foe_error.hpp"
#include "tests/ecat/firmware/firmware_bench.hpp"

namespace taktwerk::ecat::test {
namespace {

const std::string page = std::string(TAKTWERK_SOURCE_DIR) + "/docs/foe.md";
constexpr std::string_view table_begins = "<!-- interruptions: begin -->\n", table_ends = "<!-- interruptions: end -->\n";

/// Of an update that is under way. The first two come once.
enum class Moment : std::uint8_t { boot_entered, half_written, other };

/// What happens, and what is there when somebody looks again.
struct Interruption {
    const char* name;
    /// Asked at each look at the wire while the slave is in BOOT. False: the process is killed. Null: nothing was ever sent.
    bool (*strike)(FirmwareBench& bench, Moment moment);
    std::vector<std::byte> (*file)() = [] { return FirmwareBench::image("2.0", 2); };
    std::uint32_t password = 0;  ///< that is given; the slave wants none
    std::uint32_t wanted = 0;
};

bool nothing(FirmwareBench&, Moment) { return true; }

const Interruption interruptions[] = {
    {"the file cannot be read (disk)", nullptr},
    {"wrong password", nothing, [] { return FirmwareBench::image("2.0", 2); }, 1, 4711},
    {"the slave is busy for ever, before the first packet",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::boot_entered) bench.gauge().foe()->faults().stays_busy = true;
         return true;
     }},
    {"cable pulled in the middle",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::half_written) bench.network.set_cable(gauge_place, false);
         return true;
     }},
    {"slave's power lost in the middle",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::half_written) bench.network.set_power(gauge_place, false);
         return true;
     }},
    {"power lost and back at once",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::half_written) bench.power_cycle();
         return true;
     }},
    {"command killed in the middle (kill -9, PC off)", [](FirmwareBench&, Moment moment) { return moment != Moment::half_written; }},
    {"no answer any more (time-out)",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::half_written) bench.gauge().foe()->faults().silent = 1'000'000;
         return true;
     }},
    {"its firmware hangs",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::half_written) bench.gauge().hang(true);
         return true;
     }},
    {"flash error in the middle",
     [](FirmwareBench& bench, Moment moment) {
         if (moment == Moment::half_written) bench.gauge().foe()->faults() = {0, false, 0, 30, foe_error::flash_problem};
         return true;
     }},
    {"file is damaged", nothing,
     [] {
         auto file = FirmwareBench::image("2.0", 2);
         file[5000] ^= std::byte{1};
         return file;
     }},
    {"file is of another device", nothing, [] { return FirmwareBench::image("2.0", 2, 0x9999); }},
    {"file is no firmware", nothing, [] { return std::vector<std::byte>(3000, std::byte{'x'}); }},
    {"power lost while the last packet is checked",
     [](FirmwareBench& bench, Moment) {
         // All bytes are in the flash, the answer is not out.
         const bool all = bench.gauge().files()->flash().written() == FirmwareBench::image("2.0", 2).size();
         if (all && bench.gauge().powered()) bench.network.set_power(gauge_place, false);
         return true;
     }},
};

std::string state_text_of(FirmwareBench& bench) {
    if (!bench.gauge().powered()) return "off";
    switch (bench.gauge().state()) {
        case sim::EsmState::init: return "INIT";
        case sim::EsmState::preop: return "PREOP";
        case sim::EsmState::boot: return "BOOT";
        case sim::EsmState::safeop: return "SAFEOP";
        case sim::EsmState::op: return "OP";
    }
    return "?";
}

std::string firmware_text_of(FirmwareBench& bench) {
    const auto runs = bench.running();
    return runs.empty() ? "boot loader alone" : "runs " + runs;
}

struct Seen {
    std::string said, left, after;
};

/// The update that is interrupted, a look, a power cycle with everything mended, and the update once more.
Seen interrupted(const Interruption& what, unsigned banks) {
    FirmwareBench bench{banks, what.wanted};
    bool booted = false, halved = false;
    const auto moment = [&] {
        if (!std::exchange(booted, true)) return Moment::boot_entered;
        constexpr std::size_t half = 6000;
        if (bench.gauge().files()->flash().written() >= half && !std::exchange(halved, true)) return Moment::half_written;
        return Moment::other;
    };
    Seen seen{"`foe.file`; nothing is sent", {}, {}};
    if (what.strike != nullptr) {
        const auto outcome = bench.update(
            what.file(),
            [&] {
                if (bench.gauge().state() != sim::EsmState::boot) return true;
                return what.strike(bench, moment());
            },
            what.password);
        if (!outcome) {
            EXPECT_EQ(outcome.error().code, "bus.interrupted");
            seen.said = "-";
        } else if (!outcome->failure) {
            ADD_FAILURE() << what.name << ": not interrupted";
        } else {
            const auto code = foe_code(*outcome->failure);
            seen.said = fmt::format("`{}`{}; {}", outcome->failure->code, code != 0 ? fmt::format(" {:04X}h", code) : "",
                                    outcome->left.silent ? "silent" : std::string{name(outcome->left.state)});
            // What it says of the slave's state is what it is.
            if (!outcome->left.silent) {
                EXPECT_EQ(std::string{name(outcome->left.state)}, state_text_of(bench)) << what.name;
            }
            if (outcome->firmware() == FirmwareLeft::untouched) {
                EXPECT_EQ(bench.running(), "1.0") << what.name;
            }
            EXPECT_FALSE(way_back(outcome->left, outcome->firmware()).empty());
        }
    }
    seen.left = state_text_of(bench);
    // Mended: cable in, power on, nobody hangs.
    bench.network.set_cable(gauge_place, true);
    bench.gauge().foe()->faults() = {};
    bench.power_cycle();
    seen.after = firmware_text_of(bench);
    const auto again = bench.update(FirmwareBench::image("3.0", 3), {}, what.wanted);
    EXPECT_TRUE(again && !again->failure) << what.name << ": " << (again ? again->failure->text() : again.error().text());
    EXPECT_EQ(bench.running(), "3.0") << what.name << ": the way back";
    return seen;
}

std::string table() {
    std::string out =
        "| interruption | the command says | slave, two banks | after power-on | slave, one bank | after power-on "
        "|\n|---|---|---|---|---|---|\n";
    for (const auto& what : interruptions) {
        const Seen two = interrupted(what, 2), one = interrupted(what, 1);
        EXPECT_EQ(two.said, one.said) << what.name << ": the command cannot know how many banks there are";
        out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", what.name, two.said, two.left, two.after, one.left, one.after);
    }
    return out;
}

TEST(FirmwareInterruptions, LeaveTheSlaveAsThePageSays) {
    const std::string now = table();
    std::ifstream file{page};
    std::string text{std::istreambuf_iterator<char>{file}, {}};
    const auto begin = text.find(table_begins), end = text.find(table_ends);
    ASSERT_NE(begin, std::string::npos) << page;
    ASSERT_NE(end, std::string::npos) << page;
    const auto from = begin + table_begins.size();
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) {
        std::ofstream{page} << text.substr(0, from) << now << text.substr(end);
        return;
    }
    EXPECT_EQ(text.substr(from, end - from), now) << "TAKTWERK_REGENERATE=1 build/dev/ecat/ecat_firmware_machine";
}

}  // namespace
}  // namespace taktwerk::ecat::test
