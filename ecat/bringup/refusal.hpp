#pragma once
// "Why not OP": everything that is known when a slave does not take a state, as plain data. The error's text and
// `taktwerk bus why` are made from the same struct. Pure; gathered by read_refusal() (al_control.hpp).
// Source: ETG.1000.6 (ESM), ETG.1020 (what a slave checks before each state).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/wire/al_status.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

/// One sync manager: what the master planned, what the controller holds, what the slave's own words ask for.
struct RefusedSyncManager {
    std::uint8_t number = 0;
    std::optional<SyncManager> planned;          ///< none: nothing was planned for it
    std::optional<SyncManager> found;            ///< read back from the controller
    std::optional<std::uint16_t> mapping_bytes;  ///< process data: as the slave reports its PDOs
    std::optional<std::uint16_t> sii_bytes;      ///< by its EEPROM, 0: not stated there
};

struct RefusedFmmu {
    std::uint8_t number = 0;
    std::optional<Fmmu> planned, found;
};

/// The clock of the slave and what was asked of it.
struct RefusedClock {
    bool supported = false, required = false;   ///< by its description
    bool configured = false;                    ///< `dc` of the slave
    bool started = false;                       ///< the master wrote start time and activation
    std::optional<std::uint8_t> activation;     ///< 0981h as read
    std::optional<Duration> sync0_cycle;        ///< 09A0h as read
    std::optional<std::int64_t> difference_ns;  ///< 092Ch as read, magnitude
    Duration bus_cycle{};
};

struct Refusal {
    std::string subject;  ///< "slave 3 'y_drive' (sv33-e)"
    AlState asked = AlState::unknown, reached = AlState::unknown;
    std::uint16_t status = 0;  ///< AL status, 0130h
    std::uint16_t code = 0;    ///< AL status code, 0134h; 0: none
    bool timed_out = false;    ///< the slave shows no error, the state just did not come
    Duration waited{};
    std::vector<RefusedSyncManager> sync_managers;
    std::vector<RefusedFmmu> fmmus;
    RefusedClock clock;
    std::optional<std::uint16_t> sm_watchdog_ticks;  ///< 0420h as read; 0: off
    bool valid_outputs = false;                      ///< the cycle exchanges process data with the right working counters
    std::string last_abort;                          ///< of an SDO to this slave; empty: none
    std::string cause, remedy;                       ///< filled by judge()
};

/// Fills cause and remedy from the facts; the status code alone decides where the facts say nothing better.
void judge(Refusal& refusal);

/// "refused SAFEOP, is in PREOP: 0x001D invalid output configuration"
[[nodiscard]] std::string headline(const Refusal& refusal);
/// Each fact as a line of its own: sizes configured and expected, FMMUs, clock, watchdog, last abort.
[[nodiscard]] std::vector<std::string> fact_lines(const Refusal& refusal);
/// bus.refused_state or bus.state_timeout: headline, facts and cause in one sentence, and the remedy.
[[nodiscard]] Error refusal_error(const Refusal& refusal);

}  // namespace taktwerk::ecat
