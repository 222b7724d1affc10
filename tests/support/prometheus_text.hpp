// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace tinsmith::testing_support {

/// A scrape as Prometheus reads it (exposition format, version 0.0.4), and everything that is wrong
/// with it by the format and by Prometheus' conventions. A reader of our own: what is tested is not
/// also the judge.
class PrometheusText {
  public:
    explicit PrometheusText(const std::string& text) {
        if (text.empty() || text.back() != '\n') faults_ += "the last line has no end\n";
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("# ")) {
                read_comment(line);
            } else {
                read_sample(line);
            }
        }
        for (const auto& [series, buckets] : buckets_)
            check_buckets(series, buckets);
        for (const auto& [name, type] : types_) {
            if (!helps_.contains(name)) fault("no HELP", name);
            if (type == "counter" && !name.ends_with("_total"))
                fault("counter without _total", name);
            if (type != "counter" && name.ends_with("_total")) fault("_total of no counter", name);
        }
    }

    /// A line for each; empty: none.
    const std::string& faults() const { return faults_; }

    /// By `name{label="value",…}`, labels as written; NaN where there is no such series.
    double value(const std::string& series) const {
        const auto found = values_.find(series);
        return found == values_.end() ? NAN : found->second;
    }

    /// As many series as begin so.
    std::size_t count(const std::string& prefix = {}) const {
        std::size_t count = 0;
        for (auto at = values_.lower_bound(prefix);
             at != values_.end() && at->first.starts_with(prefix); ++at)
            ++count;
        return count;
    }

    /// Whether a family, or a part of a histogram, has that name.
    bool has(const std::string& name) const { return names_.contains(name); }

  private:
    void fault(const std::string& what, const std::string& where) {
        faults_ += what + ": " + where + "\n";
    }

    void read_comment(const std::string& line) {
        static const std::regex kForm(R"(# (HELP|TYPE) ([a-zA-Z_:][a-zA-Z0-9_:]*) (.+))");
        std::smatch match;
        if (!std::regex_match(line, match, kForm)) return fault("no comment of the format", line);
        const std::string name = match[2];
        if (match[1] == "HELP") {
            if (!helps_.insert(name).second) fault("two HELPs", name);
            return;
        }
        static const std::set<std::string> kTypes{"counter", "gauge", "histogram"};
        if (!kTypes.contains(match[3])) fault("unknown type", line);
        if (!types_.emplace(name, match[3]).second) fault("two TYPEs", name);
        family_ = name;
    }

    /// The family that a sample belongs to must be the one told of last.
    std::string family_of(const std::string& name, std::string& part) const {
        part.clear();
        if (types_.contains(name)) return name;
        for (const char* suffix : {"_bucket", "_sum", "_count"}) {
            if (!name.ends_with(suffix)) continue;
            const std::string family = name.substr(0, name.size() - std::string(suffix).size());
            const auto type = types_.find(family);
            if (type == types_.end() || type->second != "histogram") continue;
            part = suffix;
            return family;
        }
        return {};
    }

    void read_sample(const std::string& line) {
        static const std::regex kForm(
            R"(([a-zA-Z_:][a-zA-Z0-9_:]*)(\{(.*)\})? (NaN|[+-]Inf|[-+0-9.eE]+))");
        static const std::regex kLabel(
            R"re(([a-zA-Z_][a-zA-Z0-9_]*)="((?:[^"\\\n]|\\["\\n])*)"(,|$))re");
        std::smatch match;
        if (!std::regex_match(line, match, kForm)) return fault("no sample of the format", line);
        const std::string name = match[1];
        std::string labels = match[3], part, le, others;
        const std::string family = family_of(name, part);
        if (family.empty() || family != family_) fault("a sample outside its family", line);
        std::set<std::string> seen;
        std::smatch label;
        while (!labels.empty()) {
            if (!std::regex_search(labels, label, kLabel, std::regex_constants::match_continuous)) {
                return fault("broken labels", line);
            }
            if (!seen.insert(label[1]).second) fault("a label twice", line);
            if (label[1] == "le") {
                le = label[2];
            } else {
                others += label[1].str() + "=" + label[2].str() + ",";
            }
            labels = label.suffix();
        }
        if (part == "_bucket" && le.empty()) fault("a bucket without le", line);
        char* end = nullptr;
        const std::string number = match[4];
        const double value = std::strtod(number.c_str(), &end);
        if (*end != '\0') fault("no number", line);
        const bool only_grows = types_[family] != "gauge";
        if (only_grows && !(value >= 0.0)) fault("below zero", line);
        if (!values_.emplace(line.substr(0, line.rfind(' ')), value).second)
            fault("a series twice", line);
        names_.insert(name);
        if (types_[family] != "histogram") return;
        Buckets& buckets = buckets_[family + "{" + others];
        if (part.empty()) fault("a histogram without parts", line);
        if (part == "_sum") buckets.has_sum = true;
        if (part == "_count") buckets.count = value;
        if (part == "_bucket" &&
            !buckets.by_bound.emplace(std::strtod(le.c_str(), nullptr), value).second)
            fault("a bucket twice", line);
    }

    struct Buckets {
        std::map<double, double> by_bound;
        double count = -1.0;
        bool has_sum = false;
    };

    void check_buckets(const std::string& series, const Buckets& buckets) {
        double before = 0.0;
        for (const auto& [bound, count] : buckets.by_bound) {
            if (count < before) fault("buckets that do not add up", series);
            before = count;
        }
        if (buckets.by_bound.empty() || !std::isinf(buckets.by_bound.rbegin()->first))
            fault("no bucket of all", series);
        if (before != buckets.count) fault("a count that is not that of all", series);
        if (!buckets.has_sum) fault("no sum", series);
    }

    std::string faults_;
    std::string family_;
    std::map<std::string, std::string> types_;
    std::set<std::string> helps_;
    std::set<std::string> names_;
    std::map<std::string, double> values_;
    std::map<std::string, Buckets> buckets_;
};

}  // namespace tinsmith::testing_support
