// Is a machine well? Judged from the socket's answers, which may be anybody's.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/machine/health.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Json hello() {
    return Json{{"machine", "cell"}, {"version", "0.1.0"}, {"pid", 17}, {"uptime_s", 60.0}, {"cycling", true}, {"progress", ""}};
}
Json state() {
    return Json::parse(R"({"phase":"running","mode":"automatic","simulated":false,"emergency_stop":false,
        "bus":{"phase":"operational","frames_lost":0},"statistics":{"cycles":60000,"missed_ticks":1,"lateness_max_ns":45000,"compute_max_ns":80000,"page_faults":7},
        "axes":[{"powered":true,"homed":true},{"powered":false,"homed":true}],"programs":[{"name":"cell","state":"running"}],
        "tasks":[{"name":"cell.main","releases":60000,"overruns":2,"run_ns":12000,"run_max_ns":40000}],
        "alarms":[{"source":"axis x","name":"following_warning","english":"w","reaction":"warn","standing":true}]})");
}

TEST(HealthOf, AMachineThatRunsIsWellAlsoWithAWarning) {
    const auto h = health_of(hello(), state());
    EXPECT_THAT(h.unwell, IsEmpty());
    EXPECT_EQ(h.axes, 2u);
    EXPECT_EQ(h.powered, 1u);
    EXPECT_EQ(h.homed, 2u);
    EXPECT_THAT(health_text(h), HasSubstr("cell: well\n"));
    EXPECT_THAT(health_text(h), HasSubstr("wake-up at most 45 us late"));
    EXPECT_THAT(health_text(h), HasSubstr("task cell.main: 60000 runs, 2 overruns, 12 us, at most 40 us\n"));
    const auto json = health_json(h);
    EXPECT_EQ(json["well"], true);
    EXPECT_EQ(json["pid"], 17);
    EXPECT_EQ(json["lateness_max_us"], 45.0);
    EXPECT_EQ(json["tasks"][0]["name"], "cell.main");
    EXPECT_EQ(json["tasks"][0]["run_max_us"], 40.0);
    EXPECT_THAT(health_text(h), HasSubstr("7 page faults of the cycle"));
    EXPECT_EQ(json["page_faults"], 7);
    for (const auto* counted : {"cycles", "missed_ticks", "frames_lost", "page_faults"})
        EXPECT_TRUE(json[counted].is_number_unsigned()) << counted << ": who reads it into a whole number takes no 60000.0";
    EXPECT_TRUE(json["tasks"][0]["runs"].is_number_unsigned());
}

// A machine whose group a person holds is well, and who wonders why nothing moves is told.
TEST(HealthOf, WhatAPersonHoldsIsNamed) {
    auto s = state();
    s["groups"] = Json::parse(R"([{"name":"arm","held":true},{"name":"table","held":false}])");
    const auto h = health_of(hello(), s);
    EXPECT_TRUE(h.well());
    EXPECT_THAT(health_text(h), HasSubstr("group arm: a person has interrupted it; `taktwerk group continue arm` lets it go on\n"));
    EXPECT_EQ(health_json(h)["held"], Json({"arm"}));
}

TEST(HealthOf, WhatStopsSomethingIsNamed) {
    auto s = state();
    s["alarms"].push_back({{"source", "axis y"},
                           {"name", "drive_fault"},
                           {"english", "The drive reports a fault"},
                           {"reaction", "stop axis"},
                           {"standing", false}});
    const auto h = health_of(hello(), s);
    EXPECT_THAT(h.unwell, ElementsAre("axis y, drive_fault (waits for a reset): The drive reports a fault"));
    EXPECT_EQ(health_json(h)["alarms"].size(), 1u) << "warnings are not among them";
}

TEST(HealthOf, EachWayToBeUnwellHasItsWord) {
    auto s = state();
    s["emergency_stop"] = true;
    EXPECT_THAT(health_of(hello(), s).unwell, ElementsAre("the emergency stop is pressed"));
    s = state();
    s["programs"][0]["state"] = "fault";
    EXPECT_THAT(health_of(hello(), s).unwell, ElementsAre("program cell is in fault"));
    s = state();
    s["bus"]["phase"] = "recovering";
    EXPECT_THAT(health_of(hello(), s).unwell, ElementsAre("the bus is recovering"));
    s = state();
    s["phase"] = "stopping";
    EXPECT_THAT(health_of(hello(), s).unwell, ElementsAre("it is stopping"));
    auto h = hello();
    h["cycling"] = false, h["progress"] = "task 'main' of program 'cell' does not return";
    EXPECT_THAT(health_of(h, state()).unwell, ElementsAre("it does not cycle: task 'main' of program 'cell' does not return"));
    EXPECT_THAT(health_of(hello(), Json{}).unwell, ElementsAre("it does not cycle"));
}

// What is not there is unwell, never well by default; what is of another type is for understood() (remote.hpp).
TEST(HealthOf, WhatIsNotSaidIsNotWell) {
    EXPECT_FALSE(health_of(Json::object(), Json::object()).well());
    EXPECT_FALSE(health_of(hello(), Json::object()).well());
    for (const char* key : {"phase", "bus"}) {
        auto s = state();
        s.erase(key);
        EXPECT_FALSE(health_of(hello(), s).well()) << key;
    }
    for (const char* text : {"[]", "7", R"({"axes":[null]})", R"({"alarms":[{"reaction":3}]})", R"({"bus":3})"}) {
        const auto odd = Json::parse(text);
        if (odd.is_object()) EXPECT_THROW((void)health_of(hello(), odd), nlohmann::json::exception) << text;
        else EXPECT_FALSE(health_of(hello(), odd).well()) << text;
    }
}

}  // namespace
}  // namespace taktwerk::apps
