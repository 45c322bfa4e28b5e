#pragma once
// Why a bus does not reach OP, slave by slave: asked after a bring-up has ended with an error, while everything still stands
// as it failed. Reads only. What a refused state looks like in detail is ecat/bringup/refusal.hpp's business.

#include <optional>
#include <string>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

struct WhySlave {
    std::string subject;
    std::uint16_t position = 0;
    bool answers = true;
    bool failed = false;  ///< it stands in the way; the others only wait for it
    AlState state = AlState::unknown;
    bool al_error = false;
    std::uint16_t al_code = 0;
    std::optional<Refusal> facts;  ///< of failed slaves that answer: sizes, FMMUs, clock, last abort
    std::string cause, remedy;     ///< of failed slaves
};

struct WhyReport {
    Error failure;                 ///< what the bring-up said
    std::vector<WhySlave> slaves;  ///< configured slaves, in their order, without groups that are away; empty when the scan failed
    std::vector<std::string> notes;
};

/// `failure`: of the bring-up that has just failed on `bus`.
[[nodiscard]] Script<Result<WhyReport>> explain(Bus& bus, Error failure);

}  // namespace taktwerk::ecat
