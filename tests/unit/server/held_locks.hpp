// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <shared_mutex>

#include "server/services.hpp"

namespace tinsmith::server {

// How a test holds a lock that nobody gives out: an explicit instantiation may name what is
// private.
template <typename Tag, typename Tag::Type Lock>
struct OpenedLock {
    friend typename Tag::Type lock_of(Tag) { return Lock; }
};
#define TINSMITH_OPENED_LOCK(tag, owner, mutex, member) \
    struct tag {                                        \
        using Type = mutex owner::*;                    \
        friend Type lock_of(tag);                       \
    };                                                  \
    template struct OpenedLock<tag, &owner::member>
TINSMITH_OPENED_LOCK(StoreLock, SessionStore, std::shared_mutex, mutex_);
TINSMITH_OPENED_LOCK(MeshLock, Session, std::shared_mutex, mutex_);
TINSMITH_OPENED_LOCK(TurnLock, Session, std::mutex, turn_);
TINSMITH_OPENED_LOCK(ViewLock, Session, std::mutex, view_mutex_);
TINSMITH_OPENED_LOCK(CacheLock, MeshCache, std::mutex, mutex_);
TINSMITH_OPENED_LOCK(AnswersLock, KeptAnswers, std::mutex, mutex_);
TINSMITH_OPENED_LOCK(JobsLock, Jobs, std::mutex, mutex_);
#undef TINSMITH_OPENED_LOCK

/// What an edit of the session holds while it runs: nobody reads the mesh, nobody gets in line.
class EditOf {
  public:
    explicit EditOf(Session& session)
        : turn_(session.*lock_of(TurnLock{})), mesh_(session.*lock_of(MeshLock{})) {}

  private:
    std::unique_lock<std::mutex> turn_;
    std::unique_lock<std::shared_mutex> mesh_;
};

/// Every lock that the services of a process and this session have, in the order in which the code
/// takes them.
class AllLocksOf {
  public:
    AllLocksOf(Services& services, Session& session)
        : edit_(session),
          store_(services.sessions.*lock_of(StoreLock{})),
          view_(session.*lock_of(ViewLock{})),
          meshes_(services.meshes.*lock_of(CacheLock{})),
          answers_(services.answers.*lock_of(AnswersLock{})),
          jobs_(services.jobs.*lock_of(JobsLock{})) {}

  private:
    EditOf edit_;
    std::unique_lock<std::shared_mutex> store_;
    std::unique_lock<std::mutex> view_;
    std::unique_lock<std::mutex> meshes_;
    std::unique_lock<std::mutex> answers_;
    std::unique_lock<std::mutex> jobs_;
};

}  // namespace tinsmith::server
