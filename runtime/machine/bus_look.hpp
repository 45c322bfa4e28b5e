#pragma once
// How the slaves' ports and error counters stand now, of a bus that runs: a script that takes a few datagrams which the cycle has to spare, among the
// services of the bus, so that a recording has it in its order. Service side, not real-time.

#include <optional>

#include "ecat/diagnosis/running_survey.hpp"
#include "runtime/machine/machine_body.hpp"

namespace taktwerk::runtime {

class BusLook {
public:
    static constexpr Duration patience = std::chrono::milliseconds{1500};  ///< then what is known is the answer

    explicit BusLook(MachineBody& body) : body_(body) {}

    /// One that is under way is joined.
    void begin() noexcept { wanted_ = wanted_ || !under_way(); }
    [[nodiscard]] bool under_way() const noexcept { return wanted_ || runner_.has_value(); }
    /// Of the last look; what the master knows by itself where there was none, or the bus was not operational.
    [[nodiscard]] const ecat::Survey& survey() const noexcept { return survey_; }

    /// Among the services of the bus.
    void step(Instant now);

private:
    MachineBody& body_;
    ecat::Survey survey_;
    std::optional<ecat::Runner> runner_;  // it holds entries of the bus' port
    Instant begun_{};
    bool wanted_ = false;
};

}  // namespace taktwerk::runtime
