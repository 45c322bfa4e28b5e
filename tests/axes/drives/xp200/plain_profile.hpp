#pragma once
// An XP200 as structs, for tests below config/: numbers, ranges and factory values from its manual.

#include <memory>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes::xp200 {

using namespace std::chrono_literals;

/// The rows the model needs, from the tables 5.1.1, 5.1.2 and 9.2 of the manual.
inline std::shared_ptr<const DriveProfile> plain_profile() {
    struct Row {
        std::uint16_t number;
        std::int64_t low, high, value;
        bool restart = false;
    };
    static constexpr Row rows[] = {
        {0, 0, 9999, 315},     {4, 0, 8, 0, true},       {5, 1, 3000, 50},      {9, 1, 1000, 40},      {25, 0, 3, 0},
        {26, 0, 2, 0},         {29, 1, 32767, 1},        {30, 1, 32767, 1},     {34, 0, 11111, 0},     {60, 0, 10000, 100},
        {61, 0, 10000, 100},   {63, 0, 10000, 1000},     {65, 0, 300, 300},     {66, -300, 0, -300},   {67, 0, 300, 100},
        {68, -300, 0, -100},   {70, 1, 300, 140},        {71, -300, -1, -140},  {72, 1, 30000, 5000},  {75, 0, 6000, 3500},
        {78, 0, 5000, 1000},   {79, 1, 5000, 100},       {80, 0, 32767, 400},   {82, 1, 32767, 2500},  {97, 0, 33, 33},
        {98, 0, 1, 0},         {100, -21, 21, 1},        {101, -21, 21, 2},     {102, -21, 21, 3},     {103, -21, 21, 4},
        {104, -21, 21, 20},    {105, -21, 21, 21},       {108, -12, 12, 2},     {109, -12, 12, 3},     {110, -12, 12, 5},
        {111, -12, 12, 8},     {120, 0, 11111, 0},       {121, 0, 11111, 0},    {122, 0, 11111, 0},    {123, 0, 11111, 0},
        {124, 0, 11111, 0},    {125, 1, 1000, 5},        {136, 0, 1, 0},        {137, -5000, 5000, 0}, {138, -5000, 5000, 0},
        {139, -5000, 5000, 0}, {145, -300, 300, 0},      {146, -300, 300, 0},   {147, -300, 300, 0},   {150, 0, 32767, 10},
        {152, 0, 32767, 500},  {154, -5000, 5000, 500},  {157, -300, 300, 100}, {160, 0, 1000, 10},    {162, 0, 1, 0},
        {164, 0, 1, 0},        {165, 0, 1000, 5},        {166, 0, 5000, 500},   {167, 0, 5000, 500},   {168, 0, 3000, 100},
        {169, 0, 5000, 500},   {181, -1, 247, -1, true}, {182, 0, 3, 2, true},  {183, 0, 5, 1, true},  {204, 1, 4000, 60},
    };
    auto profile = std::make_shared<DriveProfile>();
    profile->name = "xp200";
    profile->modes = {DriveMode::profile_velocity, DriveMode::profile_torque};
    profile->enable_delay = 600ms;
    profile->mode_rules.change_at_standstill = true;
    profile->input_bit_home = 5;
    for (const auto& row : rows) {
        DriveParameter p;
        p.address = {row.number, 0};
        p.minimum = row.low;
        p.maximum = row.high;
        p.value = row.value;
        p.is_signed = row.low < 0;
        p.effect = row.restart ? ParameterEffect::after_restart : ParameterEffect::at_once;
        profile->parameters.push_back(p);
    }
    for (const auto& [code, resettable] : {std::pair{1, true}, {3, false}, {6, true}, {12, true}, {13, true}, {29, true}}) {
        DriveAlarmText alarm;
        alarm.code = static_cast<std::uint16_t>(code);
        alarm.resettable = resettable;
        profile->alarms.push_back(alarm);
    }
    return profile;
}

}  // namespace taktwerk::axes::xp200
