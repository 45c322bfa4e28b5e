#pragma once
// Simulated slaves and a probe on their cable, in virtual time.

#include <gtest/gtest.h>

#include "ecat/diagnosis/bus_probe.hpp"
#include "ecat/diagnosis/derived_config.hpp"
#include "ecat/diagnosis/survey.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {

/// `devices` as TestBus has them: "s" a servo, "t" a terminal.
class ProbedBus : public TestBus {
public:
    explicit ProbedBus(const std::string& devices) : TestBus(devices) {}

    [[nodiscard]] BusProbe probe(BusConfig with = {}) {
        return BusProbe{transport, std::move(with), [this](Duration period) {
                            now += period;
                            return std::optional{now};
                        }};
    }
    [[nodiscard]] Survey look() {
        auto looking = probe();
        auto found = looking.run(survey(looking.port()));
        EXPECT_TRUE(found) << (found ? "" : found.error().text());
        return found ? std::move(*found) : Survey{};
    }
};

}  // namespace taktwerk::ecat::test
