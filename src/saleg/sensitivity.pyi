from saleg.studies.sensitivity import *
