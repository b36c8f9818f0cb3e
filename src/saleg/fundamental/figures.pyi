from saleg.thesis.chapter_2 import *
