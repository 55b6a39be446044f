/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of context that this build has, each drawn by Mesa's llvmpipe; a kind that it does not have is refused. */
#include "testing.h"

#include "pixels/gl.h"
#include "pixels/gl_functions.h"
#include "pictures/mesa.h"

TEST(the_first_kind_is_the_default) {
    Context context;
    assert_non_null(context_kinds[0]);
    assert_ok(context_create(&context, CONTEXT_AUTO, &error), error);
    assert_ptr_equal(context.kind, context_kinds[0]);
    context_destroy(&context);
}

TEST(every_kind_draws_by_llvmpipe) {
    for (int i = 0; context_kinds[i] != NULL; i++) {
        Context context;
        GlFunctions gl;
        assert_ptr_equal(context_kind(context_kinds[i]->choice), context_kinds[i]);
        assert_ok(context_create(&context, context_kinds[i]->choice, &error), error);
        assert_ok(gl_load(&gl, context.kind->find, context.state, &error), error);
        assert_non_null(strstr((const char *)gl.GetString(GL_RENDERER), "llvmpipe"));
        print_message("built in: %s\n", context_kinds[i]->name);
        context_destroy(&context);
    }
}

TEST(a_kind_that_is_not_built_in_is_refused) {
    for (ContextChoice choice = CONTEXT_OSMESA; choice <= CONTEXT_EGL; choice++) {
        Context context;
        if (context_kind(choice) != NULL) continue;
        assert_refused(context_create(&context, choice, &error), "twinbox was built without");
    }
}

TEST(only_a_missing_library_is_to_be_installed) {
    Error missing = {0}, broken = {0};
    assert_false(context_load("libnone.so.1", "libnone1", NULL, 0, NULL, &missing));
    assert_string_equal(missing.message,
                        "render: error: cannot load libnone.so.1; install the Debian package libnone1");
    assert_false(context_load(SOURCE_DIR "/README.md", "libnone1", NULL, 0, NULL, &broken));
    assert_error(broken, ERROR_SYSTEM, "README.md: invalid ELF header");
    assert_null(strstr(broken.message, "install"));
}

RUN_TESTS(NULL, NULL)
