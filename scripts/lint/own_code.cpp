// A plugin for clang-tidy that keeps its checks out of the libraries' headers. What they find there
// is hidden anyway, and looking for it takes most of a run. scripts/lint.sh builds and loads it.

#include <vector>

#include <clang-tidy/ClangTidyCheck.h>
#include <clang-tidy/ClangTidyModule.h>
#include <clang-tidy/ClangTidyModuleRegistry.h>
#include <clang/AST/ASTContext.h>

namespace {

/// Finds nothing itself. All checks walk the tree together and meet the translation unit first;
/// what is set there is all that they meet afterwards.
class OwnCode : public clang::tidy::ClangTidyCheck {
 public:
  using ClangTidyCheck::ClangTidyCheck;

  void registerMatchers(clang::ast_matchers::MatchFinder* finder) override {
    finder->addMatcher(clang::ast_matchers::translationUnitDecl().bind("unit"), this);
  }

  void check(const clang::ast_matchers::MatchFinder::MatchResult& result) override {
    std::vector<clang::Decl*> own;
    // Not those that are only in the precompiled header: it has nothing but libraries.
    for (clang::Decl* declaration : result.Context->getTranslationUnitDecl()->noload_decls()) {
      const clang::SourceLocation location = declaration->getLocation();
      if (location.isValid() && !result.SourceManager->isInSystemHeader(location)) {
        own.push_back(declaration);
      }
    }
    result.Context->setTraversalScope(own);
  }
};

class Module : public clang::tidy::ClangTidyModule {
 public:
  void addCheckFactories(clang::tidy::ClangTidyCheckFactories& factories) override {
    factories.registerCheck<OwnCode>("seedframe-own-code");
  }
};

const clang::tidy::ClangTidyModuleRegistry::Add<Module> registration("seedframe",
                                                                     "What scripts/lint.sh needs.");

}  // namespace
