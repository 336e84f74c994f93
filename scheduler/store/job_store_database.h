// The open database behind JobStore, for the sources that write it and read it.
#pragma once

#include "store/job_store.h"
#include "store/sqlite.h"

namespace seedframe {

struct JobStore::Database {
  sqlite::Connection connection;
  std::int64_t run = 0;  ///< that this store is the owner of; 0: none

  Status check_owner() const {
    if (run == 0) return {};
    sqlite::Statement select(connection, "SELECT max(run) FROM runs");
    const std::int64_t owner = select.step() ? select.integer(0) : run;
    if (Status done = select.status(); !done) return done;
    if (owner == run) return {};
    return fail(ErrorKind::kEnvironment,
                "{} belongs to run {} now: another seedframe has taken the campaign over while "
                "this one (run {}) was away. It ends, and what it had under way is not stored",
                connection.path().string(), owner, run);
  }

  /// Runs `body` between BEGIN and COMMIT, if the run still is the owner; an error rolls back.
  /// Inside a transaction it is part of that.
  template <class Body>
  Status transaction(Body body) {
    if (sqlite3_get_autocommit(connection.handle()) == 0) return body();
    if (Status begun = connection.execute("BEGIN IMMEDIATE"); !begun) return begun;
    Status done = check_owner();
    if (done) done = body();
    if (done) done = connection.execute("COMMIT");
    if (!done) (void)connection.execute("ROLLBACK");
    return done;
  }
};

}  // namespace seedframe
