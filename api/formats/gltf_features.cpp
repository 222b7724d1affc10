// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_features.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <nlohmann/json.hpp>

namespace tinsmith::api {
namespace {

using nlohmann::json;

/// Reader and writer agree on what is kept: what cannot be read any more counts as nothing.
json own_properties(const RegionFeature& feature) {
    json own = json::parse(feature.properties, nullptr, false);
    return own.is_object() ? own : json::object();
}

bool is_scalar(const json& value) {
    return value.is_string() || value.is_number() || value.is_boolean();
}

std::string text_of(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool is_exact_double(const json& value) {
    constexpr std::int64_t kLimit = std::int64_t{1} << 53;
    if (value.is_number_unsigned()) return value.get<std::uint64_t>() <= std::uint64_t{kLimit};
    if (value.is_number_integer())
        return value.get<std::int64_t>() >= -kLimit && value.get<std::int64_t>() <= kLimit;
    return value.is_number_float();
}

std::string name_of(const RegionFeature& feature, const json& own) {
    const auto name = own.find("name");
    if (name != own.end() && is_scalar(*name)) return text_of(*name);
    if (feature.client_id.empty()) return feature.id;
    const json id = json::parse(feature.client_id, nullptr, false);
    return is_scalar(id) ? text_of(id) : feature.id;
}

template <typename Value>
bool is_whole(const std::vector<std::optional<Value>>& values) {
    return std::ranges::all_of(values, [](const auto& value) { return value.has_value(); });
}

class TableBuilder {
  public:
    explicit TableBuilder(std::size_t rows) { table_.rows = rows; }

    void add_texts(PropertyColumn column, const std::vector<std::optional<std::string>>& values) {
        column.is_text = true;
        column.no_text = text_for_none(values);
        column.offsets.push_back(0);
        for (const auto& value : values) {
            column.values += value ? *value : *column.no_text;
            column.offsets.push_back(static_cast<std::uint32_t>(column.values.size()));
        }
        if (column.values.empty()) column.values.push_back('\0');  // a view is never empty
        add(std::move(column));
    }

    void add_numbers(PropertyColumn column, const std::vector<std::optional<double>>& values) {
        column.no_number = number_for_none(values);
        column.values.resize(values.size() * sizeof(double));
        for (std::size_t row = 0; row < values.size(); ++row) {
            const double number = values[row] ? *values[row] : *column.no_number;
            std::memcpy(column.values.data() + row * sizeof(double), &number, sizeof(double));
        }
        add(std::move(column));
    }

    PropertyTable take() { return std::move(table_); }

  private:
    /// Nothing where each row has a value.
    static std::optional<std::string> text_for_none(
        const std::vector<std::optional<std::string>>& values) {
        if (is_whole(values)) return std::nullopt;
        std::unordered_set<std::string_view> taken;
        for (const auto& value : values)
            if (value) taken.insert(*value);
        std::string none;
        for (std::size_t n = 0; taken.contains(none); ++n)
            none = n == 0 ? "null" : "null " + std::to_string(n);
        return none;
    }

    static std::optional<double> number_for_none(const std::vector<std::optional<double>>& values) {
        if (is_whole(values)) return std::nullopt;
        std::unordered_set<double> taken;
        for (const auto& value : values)
            if (value) taken.insert(*value);
        double none = std::numeric_limits<double>::lowest();
        while (taken.contains(none))  // at most once for each row
            none = std::nextafter(none, 0.0);
        return none;
    }

    void add(PropertyColumn column) {
        std::string id;
        for (const char c : column.name)
            id.push_back(std::isalnum(static_cast<unsigned char>(c)) != 0 && c > 0 ? c : '_');
        if (id.empty() || std::isdigit(static_cast<unsigned char>(id.front())) != 0)
            id.insert(id.begin(), '_');
        column.id = id;
        for (std::size_t n = 2; !ids_.insert(column.id).second; ++n)
            column.id = id + "_" + std::to_string(n);
        table_.columns.push_back(std::move(column));
    }

    PropertyTable table_;
    std::unordered_set<std::string> ids_;
};

/// The names of own properties that become columns, in the order of their first feature.
std::vector<std::string> own_names(const std::vector<json>& own) {
    std::vector<std::string> names;
    std::unordered_set<std::string> known{"name"};
    for (const json& properties : own) {
        for (const auto& [name, value] : properties.items()) {
            if (names.size() == kMostOwnColumns) return names;
            if (is_scalar(value) && known.insert(name).second) names.push_back(name);
        }
    }
    return names;
}

void add_own(TableBuilder& table, const std::string& name, const std::vector<json>& own) {
    std::vector<const json*> values;
    bool are_numbers = true;
    for (const json& properties : own) {
        const auto found = properties.find(name);
        const bool is_there = found != properties.end() && is_scalar(*found);
        values.push_back(is_there ? &*found : nullptr);
        are_numbers = are_numbers && (!is_there || is_exact_double(*found));
    }
    PropertyColumn column;
    column.name = name;
    if (are_numbers) {
        std::vector<std::optional<double>> numbers;
        numbers.reserve(values.size());
        for (const json* value : values)
            numbers.push_back(value == nullptr ? std::optional<double>() : value->get<double>());
        return table.add_numbers(std::move(column), numbers);
    }
    std::vector<std::optional<std::string>> texts;
    texts.reserve(values.size());
    for (const json* value : values)
        texts.push_back(value == nullptr ? std::optional<std::string>() : text_of(*value));
    table.add_texts(std::move(column), texts);
}

PropertyColumn own_column(const char* name, std::string description, const char* semantic = "") {
    PropertyColumn column;
    column.name = name;
    column.description = std::move(description);
    column.semantic = semantic;
    return column;
}

}  // namespace

PropertyTable property_table(const RegionPartition& regions) {
    std::vector<json> own;
    std::vector<std::optional<std::string>> ids, names;
    std::vector<std::optional<double>> plan_areas, surface_areas;
    for (const RegionFeature& feature : regions.features) {
        own.push_back(own_properties(feature));
        ids.emplace_back(feature.id);
        names.emplace_back(name_of(feature, own.back()));
        plan_areas.emplace_back(feature.plan_area);
        surface_areas.emplace_back(feature.surface_area);
    }
    TableBuilder table(regions.features.size());
    table.add_texts(own_column("id", "The polygon's id in the session", "ID"), ids);
    table.add_texts(own_column("name", "", "NAME"), names);
    const std::string unit = regions.unit.empty() ? "unit" : regions.unit;
    table.add_numbers(own_column("plan_area", "In plan, in square " + unit), plan_areas);
    table.add_numbers(own_column("surface_area", "Along the slopes, in square " + unit),
                      surface_areas);
    for (const std::string& name : own_names(own))
        add_own(table, name, own);
    return table.take();
}

std::string region_name(const RegionFeature& feature) {
    return name_of(feature, own_properties(feature));
}

std::string regions_extras(const RegionPartition& regions) {
    json list = json::array();
    for (const RegionFeature& feature : regions.features) {
        json own = own_properties(feature);
        const std::string name = name_of(feature, own);
        list.push_back({{"id", feature.id},
                        {"name", name},
                        {"plan_area", feature.plan_area},
                        {"surface_area", feature.surface_area},
                        {"properties", std::move(own)}});
    }
    return list.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace tinsmith::api
