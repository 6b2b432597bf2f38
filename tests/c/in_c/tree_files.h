// Files of one kind of tree or of scenes, for tree_test.h and scenes.c.

static void test_files(const TREE* tree) {
  static const char umlaut[] = "\xc3\xa4.tree";
  TREE* loaded = NULL;
  ANOTHER_TREE* another = NULL;
  unsigned char *bytes, *again;
  size_t size = 0, in_file;
  FILE* opened;
  FAILS(CALL(save)(tree, NULL, 0, &size), RAYLANES_SMALL_BUFFER, "buffer");
  EXPECT(size > 64);
  bytes = malloc(size + 1);
  again = malloc(size + 1);
  memset(bytes, 0x5a, size + 1);
  FAILS(CALL(save)(tree, bytes, size - 1, &size), RAYLANES_SMALL_BUFFER, "buffer");
  EXPECT(bytes[size - 1] == 0x5a);
  GOOD(CALL(save)(tree, bytes, size, &size));
  EXPECT(bytes[size] == 0x5a);
  GOOD(CALL(load)(&loaded, bytes, size + 1));
  expect_tetrahedron(loaded);
  CALL(destroy)(loaded);

  GOOD(CALL(save_file)(tree, file_named("a.tree")));
  opened = fopen(file_named("a.tree"), "rb");
  EXPECT(opened != NULL);
  in_file = fread(again, 1, size + 1, opened);
  EXPECT(in_file == size && memcmp(bytes, again, size) == 0);
  fclose(opened);
  GOOD(CALL(load_file)(&loaded, file_named("a.tree")));
  expect_tetrahedron(loaded);
  CALL(destroy)(loaded);
  EXPECT(remove(file_named("a.tree")) == 0);
  // Names are UTF-8, which the C library of Windows does not take.
  GOOD(CALL(save_file)(tree, file_named(umlaut)));
  GOOD(CALL(load_file)(&loaded, file_named(umlaut)));
  expect_tetrahedron(loaded);
  CALL(destroy)(loaded);
  remove(file_named(umlaut));

  FAILS(ANOTHER_LOAD(&another, bytes, size), RAYLANES_BAD_FILE, "tree file");
  EXPECT(another == NULL);
  FAILS(CALL(load)(&loaded, bytes, size - 1), RAYLANES_BAD_FILE, "tree file");
  EXPECT(loaded == NULL);
  bytes[size / 2] ^= 1;
  FAILS(CALL(load)(&loaded, bytes, size), RAYLANES_BAD_FILE, "tree file");
  FAILS(CALL(load)(&loaded, NULL, 0), RAYLANES_BAD_FILE, "tree file");
  FAILS(CALL(load_file)(&loaded, file_named("a.tree")), RAYLANES_BAD_FILE, "a.tree\": No such file");
  FAILS(CALL(save_file)(tree, "no such folder/tree"), RAYLANES_BAD_FILE,
        "tree file \"no such folder/tree\": No such");
  opened = fopen(file_named("cut"), "wb");
  fputs("no tree", opened);
  fclose(opened);
  FAILS(CALL(load_file)(&loaded, file_named("cut")), RAYLANES_BAD_FILE, "cut\": tree file: ");
  EXPECT(remove(file_named("cut")) == 0);
  /* Names that are not UTF-8 are those of files but on Windows. Lines and long names leave room for the cause. */
  FAILS(CALL(load_file)(&loaded, "no\nsuch \xff\xfe file"), RAYLANES_BAD_FILE,
        "tree file \"no?such \xff\xfe file\": ");
  memset(bytes, 'x', size);
  bytes[size < 2000 ? size - 1 : 2000] = 0;
  FAILS(CALL(load_file)(&loaded, (const char*)bytes), RAYLANES_BAD_FILE, "xxx...xxx");
  EXPECT(strstr(raylanes_last_message(), "\": ") != NULL);
  REFUSED(CALL(load)(NULL, bytes, size), KIND);
  REFUSED(CALL(load)(&loaded, NULL, size), "bytes");
  REFUSED(CALL(load)(&loaded, bytes, SIZE_MAX), "bytes");
  REFUSED(CALL(load_file)(NULL, file_named("a.tree")), KIND);
  REFUSED(CALL(load_file)(&loaded, NULL), "file");
  REFUSED(CALL(save)(NULL, bytes, size, &size), KIND);
  REFUSED(CALL(save)(tree, NULL, size, &size), "buffer");
  REFUSED(CALL(save)(tree, bytes, size, NULL), "size");
  REFUSED(CALL(save_file)(NULL, file_named("a.tree")), KIND);
  REFUSED(CALL(save_file)(tree, NULL), "file");
  free(bytes);
  free(again);
}
