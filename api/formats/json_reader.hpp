// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/fault_log.hpp"
#include "api/formats/json_tokens.hpp"
#include "api/formats/read_limits.hpp"

/// Reading JSON as it streams by, with no document tree. A body is described by what is expected
/// where: a `Value` takes one value, a `Container` says which Value takes each member or element.
/// The `Reader` between parser and expectations knows the place (a JSON Pointer at any time),
/// bounds the depth, refuses a name that an object has already, wherever the object is, and
/// collects the faults; so an expectation is a few lines that store or object. Memory beside what
/// expectations keep: at most thrice the body, and less than 20 MiB where that is less.
namespace tinsmith::api::json {

/// Deepest nesting of arrays and objects. GeoJSON needs 8; the rest is for properties.
inline constexpr std::size_t kMaxDepth = 32;

/// A value that holds no other. Text lives only as long as the event.
struct Scalar {
    enum class Kind { Null, Boolean, Natural, Negative, Real, Text };
    Kind kind = Kind::Null;
    bool boolean = false;
    /// Of Natural, Negative and Real. What is nearer to zero than any double is the double nearest
    /// to zero, so that it is no zero.
    double number = 0.0;
    std::uint64_t natural = 0;  ///< of Natural: exact
    std::int64_t negative = 0;  ///< of Negative: exact
    std::string_view text;      ///< of Text: the characters; of Real: the number as written

    bool is_number() const {
        return kind == Kind::Natural || kind == Kind::Negative || kind == Kind::Real;
    }
};

/// The scalar as plain text: "true", "-12", "2.50", the characters of a text; "null".
std::string plain_text(const Scalar& scalar);

class Reader;
class Container;

/// Takes one value. What is not overridden is a fault WRONG_TYPE that names `expected()`.
class Value {
  public:
    Value() = default;
    Value(const Value&) = delete;
    Value& operator=(const Value&) = delete;
    virtual ~Value() = default;

    virtual void scalar(Reader& reader, const Scalar& value);
    /// An object or array begins: who takes what is in it? nullptr: nobody, it is passed over.
    virtual Container* object(Reader& reader);
    virtual Container* array(Reader& reader);

  protected:
    /// For people: "a number".
    virtual std::string_view expected() const = 0;
};

/// Takes the members of one object or the elements of one array.
class Container {
  public:
    Container() = default;
    Container(const Container&) = delete;
    Container& operator=(const Container&) = delete;
    virtual ~Container() = default;

    /// Who takes the value of this member, the next element? nullptr: it is passed over.
    virtual Value* member(Reader& reader, std::string_view name);
    virtual Value* element(Reader& reader);
    /// The object or array has ended; the reader's place is the object or array itself.
    virtual void close(Reader& reader);
};

/// The place in the body and the faults so far.
class Reader {
  public:
    /// Requires: `root` outlives the reader.
    Reader(Value& root, const ReadLimits& limits)
        : root_(&root), log_(limits.max_faults), progress_(limits.progress) {}

    /// JSON Pointer of the value being read. Names of more than 200 bytes are cut in it.
    std::string pointer() const;

    /// Adds a fault at the present place, or at another.
    void fault(std::string code, std::string detail);
    void add(FaultKind kind, Fault fault);
    /// A fault after which nothing more is read.
    void stop(FaultKind kind, Fault fault);

    FaultLog& log() { return log_; }

    /// Told how much has been read. False: stop reading.
    bool has_come_to(double share);
    bool is_watched() const { return progress_ != nullptr; }

    // Events in the body's order. False: enough, stop reading.
    bool take_scalar(const Scalar& value);
    bool open(bool is_array);
    bool take_name(std::string_view name);
    bool close();
    /// What comes next is not taken, and the parser ends there: a value, or a name of the object
    /// that is open, which then is the place.
    void refuse_next(bool is_name, std::string code, std::string detail);
    bool is_in_object() const { return depth_ > 0 && !frames_[depth_ - 1].is_array; }

  private:
    struct Frame {
        Container* container = nullptr;  ///< nullptr: passed over
        bool is_array = false;
        bool started = false;     ///< a first member or element has begun
        std::uint64_t index = 0;  ///< of an array
        std::string name;         ///< of an object
        NameSet names;            ///< of an object, so far
    };

    Value* next_value();
    bool going() const { return !stopped_ && !log_.full(); }

    Value* root_;
    Value* named_ = nullptr;  ///< who takes the member whose name has just been read
    std::array<Frame, kMaxDepth> frames_;
    std::size_t depth_ = 0;
    bool stopped_ = false;
    FaultLog log_;
    const std::function<bool(double)> progress_;
};

/// Reads a body into `root`. Afterwards the reader's log says whether it was as expected.
/// Text that is no JSON is one fault with line, column and byte.
void read(std::string_view body, Reader& reader);

/// A name or text of the caller's for use in a detail: quoted, and cut when it is long.
std::string quoted(std::string_view text);
/// `base` with one more step, escaped as RFC 6901 asks.
std::string pointer_to(std::string base, std::string_view name);
std::string pointer_to(std::string base, std::uint64_t index);

}  // namespace tinsmith::api::json
